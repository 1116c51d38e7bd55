// Every experiment that comes with the program, from the booking to its numbers, on a simulated rig; and those that
// instructors make.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { assertProblem, Client, firstAdmin, person } from './client.mjs';
import { bookNow, rigIdle, runReaches, sleep } from './laboratory.mjs';
import { startServer } from './server.mjs';

const final = ['completed', 'failed', 'aborted', 'interrupted'];

/** Prepares, releases, waits for the result. */
async function runOf(client, rig, experiment, parameters) {
  await rigIdle(client, rig);
  const made = await client.post('/runs', { rig, experiment, parameters });
  assert.equal(made.status, 201, JSON.stringify(made.body));
  const ready = await runReaches(client, made.body.id, ['ready', ...final], 90);
  assert.equal(ready.state, 'ready', `${experiment}: ${ready.reason}`);
  assert.equal((await client.post(`/runs/${made.body.id}/release`)).status, 200);
  const over = await runReaches(client, made.body.id, final, 120);
  assert.equal(over.state, 'completed', `${experiment}: ${over.reason}`);
  return over;
}

// What the simulated rig was told, and how far the result may be off beside five of its uncertainties. A loaded machine
// loses frames, which the uncertainties know.
// Half a metre straight at 0.15 m/s, then an arc of at most 0.14 m radius at 60° a second.
const robotSpeed = (0.5 + (6 - 0.5 / 0.15) * 0.14 * (Math.PI / 3)) / 6;
const truths = [
  ['projectile', { speed_m_s: 2, elevation_deg: 60, duration_s: 3 }, { g: 9.81, launch_speed: 2 }],
  ['incline', { incline_deg: 6, duration_s: 4 }, { g: 9.81, angle: (6 * Math.PI) / 180, acceleration: (5 / 7) * 9.81 * Math.sin((6 * Math.PI) / 180) }],
  ['spring', { duration_s: 8, damping_per_s: 0.1 }, { angular_frequency: Math.sqrt(10 / 0.25 - 0.01), damping: 0.1 }],
  ['collision', { duration_s: 4, restitution: 0.7 }, { momentum_balance: 0, restitution: 0.7 }],
  ['robot', { duration_s: 6 }, { mean_speed: robotSpeed }],
  ['tumbler', { duration_s: 6 }, { rate: (Math.hypot(10, 60, 5) * Math.PI) / 180 }],
  ['foucault', { duration_s: 15 }, { g: 9.81 }],
];

test('every experiment runs on a simulated rig and tells what was simulated', async (t) => {
  const server = await startServer(t, { rigs: 1 });
  const admin = await firstAdmin(server);
  await bookNow(admin);
  const listed = (await admin.get('/experiments')).body.experiments.map(({ id }) => id);
  for (const [id] of truths) assert.ok(listed.includes(id), id);
  assert.deepEqual((await admin.get('/rigs/rig-1')).body.experiments.sort(), listed.sort(), 'a simulated rig does all of them');
  for (const [experiment, parameters, truth] of truths) {
    const run = await runOf(admin, 'rig-1', experiment, parameters);
    for (const [name, value] of Object.entries(truth)) {
      const measured = run.result.results.find((one) => one.name === name);
      assert.ok(measured, `${experiment} gives ${name}`);
      const off = Math.abs(measured.value - value);
      assert.ok(off < 5 * measured.u, `${experiment}: ${name} = ${measured.value} ± ${measured.u}, truly ${value}`);
      assert.ok(Math.abs(Math.hypot(...measured.budget.map(({ u }) => u)) / measured.u - 1) < 0.01, `${name}: the budget adds up`);
    }
    // Of the plank as it was seen, not of the ball's path, which only must agree.
    if (experiment === 'incline') assert.ok(Math.abs(run.result.facts.path_minus_plank_deg) < 1, JSON.stringify(run.result.warnings));
    const { plots } = (await admin.get(`/runs/${run.id}/plots`)).body;
    assert.ok(plots.length >= 3, experiment);
    for (const { name } of [...plots, { name: 'budget' }]) {
      const svg = await admin.get(`/runs/${run.id}/plots/${name}.svg`);
      assert.equal(svg.status, 200);
      assert.match(svg.body.toString(), /<svg/);
    }
    const report = await admin.get(`/runs/${run.id}/report`);
    assert.match(report.body, /Where it comes from/);
    assert.match(report.headers.get('content-security-policy'), /default-src 'none'/);
    assert.equal((await admin.get(`/runs/${run.id}/fit`)).body.objects.length, run.result.analysis.objects.length);
  }
});

test('a run is analysed again beside its first result, and an instructor makes an experiment', async (t) => {
  const server = await startServer(t, { rigs: 1 });
  const admin = await firstAdmin(server);
  const teacher = await person(admin, 'teacher', 'instructor');
  const student = await person(admin, 'student');
  await bookNow(student);
  const run = await runOf(student, 'rig-1', 'pendulum', { duration_s: 10 });
  assert.equal(run.result.accepted, false, 'five periods are too few for a good run');
  assert.ok(run.result.acceptance.find(({ fact, ok }) => fact === 'periods' && !ok).reason.length > 10);

  const before = run.result.results.find(({ name }) => name === 'g');
  const again = await student.post(`/runs/${run.id}/results`, { settings: { length_m: 1.01 } });
  assert.equal(again.status, 201, JSON.stringify(again.body));
  assert.equal(again.body.version, 2);
  const after = again.body.result.results.find(({ name }) => name === 'g');
  assert.ok(Math.abs(after.value / before.value - 1.01) < 2e-3, `${after.value} after ${before.value}`);
  const versions = (await student.get(`/runs/${run.id}/results`)).body.results;
  assert.deepEqual(versions.map(({ version, person: who }) => [version, who]), [[1, null], [2, 'Person student']]);
  assert.deepEqual(versions[0].result.results, run.result.results, 'the first one stays');
  assertProblem(await student.post(`/runs/${run.id}/results`, { settings: { lenght_m: 1 } }), 422, 'settings.lenght_m');
  assertProblem(await student.post(`/runs/${run.id}/results`, { settings: { length_m: -1 } }), 422, 'settings.length_m');
  assertProblem(await student.get(`/runs/${run.id}/plots?version=9`), 404);
  assertProblem(await student.get(`/runs/${run.id}/plots/postion.svg`), 404);
  assert.equal((await student.get(`/runs/${run.id}/plots/position.png`)).body.subarray(1, 4).toString(), 'PNG');

  const { state, version, owner, mine, ...pendulum } = (await teacher.get('/experiments/pendulum')).body;
  assert.deepEqual([state, version, owner, mine], ['built-in', null, null, false]);
  const definition = { ...pendulum, id: 'short-pendulum', title: 'Short pendulum', acceptance: [] };
  assertProblem(await student.post('/experiments', { definition }), 403);
  assertProblem(await teacher.post('/experiments', { definition: pendulum }), 409);
  const wrong = { ...definition, theory: 'Look: <img src=x onerror=alert(1)>' };
  assertProblem(await teacher.post('/experiments', { definition: wrong }), 422, 'definition.theory');
  const checked = (await teacher.post('/experiments/check', { definition: wrong })).body;
  assert.equal(checked.ok, false);
  assert.match(checked.error.message, /line 1/);
  const reading = { ...definition, objects: [{ name: 'bob', method: 'surface_patch', model: '/etc/passwd' }] };
  assertProblem(await teacher.post('/experiments', { definition: reading }), 422, 'definition.objects');

  assert.equal((await teacher.post('/experiments', { definition })).status, 201);
  assertProblem(await student.get('/experiments/short-pendulum'), 404);
  const tried = await teacher.post('/experiments/try', { definition, run: run.id });
  assert.equal(tried.status, 200, JSON.stringify(tried.body));
  assert.equal(tried.body.result.accepted, true);
  assert.equal((await student.get(`/runs/${run.id}/results`)).body.results.length, 2, 'trying stores nothing');
  assert.equal((await teacher.post('/experiments/short-pendulum/publish')).status, 204);
  assert.equal((await student.get('/experiments/short-pendulum')).body.state, 'published');
  assert.ok((await student.get('/rigs/rig-1')).body.experiments.includes('short-pendulum'));
  const own = await runOf(student, 'rig-1', 'short-pendulum', { duration_s: 10 });
  assert.equal(own.result.accepted, true);
  assert.equal((await teacher.delete('/experiments/short-pendulum')).status, 204);
  assertProblem(await student.get('/experiments/short-pendulum'), 404);
  assert.equal((await student.get(`/runs/${own.id}`)).body.result.experiment, 'short-pendulum', 'old runs keep it');
  assertProblem(await new Client(server).get('/experiments'), 401);
  await sleep(10);
});
