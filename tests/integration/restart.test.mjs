import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Client, firstAdmin, newPassword } from './client.mjs';
import { measuringRun, rigIdle, sleep, watch } from './laboratory.mjs';
import { runProgram, startServer } from './server.mjs';

async function restarted(t, server) {
  const again = await startServer(t, { data: server.data });
  assert.equal(again.password, undefined, 'the administrator is made once');
  const admin = new Client(again);
  assert.equal((await admin.signIn('admin', newPassword)).status, 200);
  return admin;
}

test('killed in the middle of a run, the server keeps every pose and says what happened', { timeout: 120_000 }, async (t) => {
  const server = await startServer(t);
  const admin = await firstAdmin(server);
  const id = await measuringRun(admin, { duration_s: 60 });
  await sleep(4000);
  await server.end('SIGKILL');
  const after = await restarted(t, server);
  const run = (await after.get(`/runs/${id}`)).body;
  assert.equal(run.state, 'interrupted');
  assert.ok(run.reason.length > 0 && run.ended_at);
  const poses = (await after.get(`/runs/${id}/poses`)).body;
  assert.ok(poses.t_s.length >= 60, `${poses.t_s.length} poses kept of about 120`);
  assert.equal(run.frames, poses.t_s.length, 'the run knows the frames that were kept');
  const fit = await after.get(`/runs/${id}/fit`);
  assert.equal(fit.status, 404);
  assert.match(fit.body.detail, /interrupted/);
  await rigIdle(after);
});

test('asked to stop in the middle of a run, it tells its viewers and ends within ten seconds', { timeout: 120_000 }, async (t) => {
  const server = await startServer(t);
  const admin = await firstAdmin(server);
  const viewer = await watch(admin);
  const id = await measuringRun(admin, { duration_s: 60 });
  await sleep(1000);
  const start = performance.now();
  const { code } = await server.end('SIGTERM');
  assert.ok(performance.now() - start < 10_000);
  assert.equal(code, 0, server.log);
  await sleep(100);
  assert.equal(viewer.closed, 1001);
  assert.equal(viewer.of('run').at(-1).run.state, 'interrupted');
  const after = await restarted(t, server);
  assert.equal((await after.get(`/runs/${id}`)).body.state, 'interrupted');
});

test('a session outlives the server', async (t) => {
  const server = await startServer(t);
  const admin = await firstAdmin(server);
  assert.equal((await server.end('SIGTERM')).code, 0);
  admin.server = await startServer(t, { data: server.data });
  assert.equal((await admin.get('/session')).status, 200);
});

test('two servers do not share a folder or a port', async (t) => {
  const server = await startServer(t);
  const folder = await runProgram(['serve', '--data', server.data, '--listen', '127.0.0.1:0']);
  assert.equal(folder.code, 1);
  assert.match(folder.stderr, /in use by another server/);
  const port = await runProgram(['serve', '--data', `${server.data}/other`, '--listen', `127.0.0.1:${server.port}`]);
  assert.equal(port.code, 1);
  assert.match(port.stderr, /cannot listen.*choose another port/s);
});

test('a wrong configuration is a usage error that names the key', async () => {
  const listen = await runProgram(['serve', '--listen', 'nowhere']);
  assert.equal(listen.code, 2);
  assert.match(listen.stderr, /listen: is 'nowhere'; give ADDRESS:PORT/);
  const variable = await runProgram(['serve'], { env: { KINECTLAB_LISTN: 'x' } });
  assert.equal(variable.code, 2);
  assert.match(variable.stderr, /KINECTLAB_LISTN.*did you mean KINECTLAB_LISTEN/);
});
