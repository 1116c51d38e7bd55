import assert from 'node:assert/strict';
import { test } from 'node:test';
import { assertProblem, firstAdmin, person } from './client.mjs';
import { eventually, measuringRun, rigIdle, runReaches, watch } from './laboratory.mjs';
import { startServer } from './server.mjs';

const columns = 't_ns,object,status,x,y,z,qx,qy,qz,qw,sx,sy,sz,vx,vy,vz,wx,wy,wz,'
  + 'srx,sry,srz,radius,s_radius,half_angle,s_half_angle,points,inlier_share,rms_steps';

test('a student runs the pendulum, watches it live and gets g', { timeout: 180_000 }, async (t) => {
  const server = await startServer(t);
  const admin = await firstAdmin(server);
  const student = await person(admin, 'student');
  const other = await person(admin, 'other');
  await rigIdle(student);
  const viewer = await watch(student);
  const id = await measuringRun(student, { duration_s: 10, amplitude_deg: 10, gravity: 9.79 });
  const late = await watch(student);
  assertProblem(await student.post(`/runs/${id}/release`), 409);
  assertProblem(await other.post(`/runs/${id}/abort`), 403);
  assertProblem(await other.get(`/runs/${id}`), 403);
  const run = await runReaches(student, id, ['completed', 'failed', 'aborted', 'interrupted']);
  assert.equal(run.state, 'completed', run.reason);

  const g = run.result.results.find((one) => one.name === 'g');
  assert.ok(Math.abs(g.value - 9.79) < 5 * g.u, `g = ${g.value} ± ${g.u}`);
  assert.ok(g.u > 0 && g.u < 0.1, `u = ${g.u}`);
  const sum = Math.sqrt(g.budget.reduce((total, line) => total + line.u ** 2, 0));
  assert.ok(Math.abs(sum - g.u) < 1e-6, 'the budget adds up');
  assert.ok(run.frames >= 290, `${run.frames} frames`);

  const csv = await student.get(`/runs/${id}/poses.csv`);
  const lines = csv.body.trimEnd().split('\n');
  assert.equal(lines[0], columns);
  assert.ok(lines.length - 1 >= 290 && lines.every((line) => line.split(',').length === 29));
  assert.match(csv.headers.get('content-disposition'), /filename="run-\d+-poses\.csv"/);
  const poses = (await student.get(`/runs/${id}/poses`)).body;
  assert.equal(poses.t_s.length, lines.length - 1);
  assert.equal(poses.x.length, poses.t_s.length);
  const fit = (await student.get(`/runs/${id}/fit`)).body;
  assert.equal(fit.objects[0].t_s.length, fit.objects[0].residual.x.length);

  await t.test('the viewer saw all of it', () => {
    assert.equal(viewer.messages[0].type, 'hello');
    assert.equal(viewer.messages[0].rig.id, 'rig-1');
    const seqs = viewer.messages.map((message) => message.seq);
    assert.ok(seqs.every((seq, i) => i === 0 || seq > seqs[i - 1]), 'seq grows');
    const states = viewer.of('run').filter((message) => message.run.id === id).map((message) => message.run.state);
    const path = ['preparing', 'ready', 'releasing', 'measuring', 'analysing', 'completed'];
    assert.deepEqual([...new Set(states)], path);
    assert.ok(viewer.of('run').at(-1).run.result, 'the result came with the last change');
    assert.ok(viewer.of('rig').some((message) => message.rig.state === 'busy'));
    const tracked = viewer.of('pose').filter((pose) => pose.status === 'tracked');
    assert.ok(tracked.length >= 280, `${tracked.length} poses`);
    assert.ok(tracked.every((pose) => [...pose.p, ...pose.s].every(Number.isFinite)));
    const moving = tracked.filter((pose) => pose.v?.every(Number.isFinite));
    assert.ok(moving.length >= tracked.length - 10, 'velocities are there but for the first sight');
    assert.ok(viewer.pictures.length > 20, `${viewer.pictures.length} pictures`);
    const picture = viewer.pictures.at(-1);
    assert.equal(picture.readUInt32LE(0), 1);
    assert.equal(picture.readUInt32LE(4), picture.length - 16);
    assert.deepEqual([...picture.subarray(16, 18)], [0xff, 0xd8], 'a JPEG');
  });

  await t.test('one who came late knows the run and the path so far', () => {
    const hello = late.messages[0];
    assert.equal(hello.run.id, id);
    assert.equal(hello.run.state, 'measuring');
    const points = hello.trail.map((point) => point[0]);
    const later = late.of('pose').map((pose) => pose.t_ns);
    assert.ok(later.length > 0 && points.every((time) => time < later[0]), 'no repetition');
    const times = [...points, ...later];
    assert.ok(times.every((time, i) => i === 0 || time > times[i - 1]), 'in order');
  });

  const list = (await student.get('/runs?mine=true&limit=1')).body;
  assert.deepEqual([list.runs[0].id, list.next], [id, null]);
  assert.deepEqual((await other.get('/runs')).body.runs, []);
  assert.equal((await admin.get('/runs?rig=rig-1')).body.runs[0].id, id);
});

test('abort ends a run without a result, stop ends it with one', { timeout: 180_000 }, async (t) => {
  const server = await startServer(t);
  const admin = await firstAdmin(server);
  const first = await measuringRun(admin, { duration_s: 60 });
  await eventually(async () => (await admin.get(`/runs/${first}`)).body, (run) => run.frames > 0, { seconds: 5 });
  const aborted = await admin.post(`/runs/${first}/abort`);
  assert.ok(aborted.body.frames > 0, 'frames are known while it measures');
  assert.equal(aborted.body.state, 'aborted');
  assert.ok(aborted.body.reason.length > 0 && aborted.body.result === null);
  assertProblem(await admin.get(`/runs/${first}/fit`), 404);
  await rigIdle(admin);

  const made = await admin.post('/runs', { rig: 'rig-1', experiment: 'pendulum', parameters: { duration_s: 60 } });
  assert.equal(made.status, 201, JSON.stringify(made.body));
  const again = await admin.post('/runs', { rig: 'rig-1', experiment: 'pendulum' });
  assertProblem(again, 409);
  await runReaches(admin, made.body.id, ['ready']);
  await admin.post(`/runs/${made.body.id}/release`);
  await runReaches(admin, made.body.id, ['measuring']);
  await new Promise((resolve) => setTimeout(resolve, 9000));
  assert.equal((await admin.post(`/runs/${made.body.id}/stop`)).status, 200);
  const run = await runReaches(admin, made.body.id, ['completed', 'failed']);
  assert.equal(run.state, 'completed', run.reason);
  assert.ok(run.result.results.some((one) => one.name === 'g'));
});
