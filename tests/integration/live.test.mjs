import assert from 'node:assert/strict';
import { test } from 'node:test';
import { assertProblem, Client, firstAdmin, newPassword, WebSocket } from './client.mjs';
import { eventually, rigIdle, sleep, watch } from './laboratory.mjs';
import { runProgram, startServer } from './server.mjs';

const ticketOf = async (client, rig = 'rig-1') => (await client.post(`/rigs/${rig}/live-ticket`)).body.ticket;
const address = (server, query, rig = 'rig-1') => `ws://127.0.0.1:${server.port}/api/v1/rigs/${rig}/live${query}`;

/** The status of the answer to an upgrade request: 101, or why not. */
function upgrade(url, options = {}) {
  return new Promise((resolve) => {
    const socket = new WebSocket(url, options);
    socket.on('open', () => { socket.terminate(); resolve(101); });
    socket.on('unexpected-response', (_, response) => { response.resume(); resolve(response.statusCode); });
    socket.on('error', () => {});
  });
}

test('a ticket opens the stream once, for its rig, from our own pages', async (t) => {
  const server = await startServer(t, { rigs: 2 });
  const admin = await firstAdmin(server);
  const ticket = await ticketOf(admin);
  assert.equal(await upgrade(address(server, `?ticket=${ticket}`)), 101);
  assert.equal(await upgrade(address(server, `?ticket=${ticket}`)), 401);
  assert.equal(await upgrade(address(server, '')), 401);
  assert.equal(await upgrade(address(server, '?ticket=guess')), 401);
  assert.equal(await upgrade(address(server, `?ticket=${await ticketOf(admin, 'rig-2')}`)), 401);

  const evil = { origin: 'http://evil.example' };
  const kept = await ticketOf(admin);
  assert.equal(await upgrade(address(server, `?ticket=${kept}`), evil), 403);
  assert.equal(await upgrade(address(server, `?ticket=${kept}`), { origin: server.url }), 101);
  assertProblem(await admin.get('/rigs/rig-1/live?ticket=x'), 426);
  assertProblem(await admin.post('/rigs/rig-9/live-ticket'), 404);
  assert.ok(!server.log.includes(ticket), 'a ticket is in the log');
});

test('signing out ends the streams and tickets of that session, and no other', async (t) => {
  const server = await startServer(t);
  const admin = await firstAdmin(server);
  const elsewhere = new Client(server);
  await elsewhere.signIn('admin', newPassword);
  await rigIdle(admin);
  const over = await watch(admin);
  const kept = await watch(elsewhere);
  const ticket = await ticketOf(admin);
  assert.equal((await admin.delete('/session')).status, 204);
  assert.equal(await upgrade(address(server, `?ticket=${ticket}`)), 401);
  assert.equal(await eventually(() => over.closed, (code) => code !== undefined, { seconds: 3 }), 1008);
  assert.equal(kept.closed, undefined);

  const reset = await runProgram(['user', 'reset', 'admin', '--data', server.data]);
  assert.equal(reset.code, 0, reset.stderr);
  assert.equal(await eventually(() => kept.closed, (code) => code !== undefined, { seconds: 5 }), 1008);
});

test('what a client may not say ends its connection, and nobody else notices', async (t) => {
  const server = await startServer(t);
  const admin = await firstAdmin(server);
  await rigIdle(admin);
  const quiet = await watch(admin);
  const say = async (what) => {
    const viewer = await watch(admin);
    viewer.socket.on('error', () => {});
    viewer.socket.send(what);
    return eventually(() => viewer.closed, (code) => code !== undefined, { seconds: 5 });
  };
  for (const nonsense of ['hello', '{"ack":-1}', '{"ack":"1"}', '{"ack":1,"more":2}', '[]', '{"ack":1e400}', Buffer.from([1, 2])]) {
    assert.equal(await say(nonsense), 1008, String(nonsense));
  }
  assert.equal(await say('x'.repeat(5000)), 1009);
  const before = quiet.messages.length + quiet.pictures.length;
  await sleep(1000);
  assert.equal(quiet.closed, undefined);
  assert.ok(quiet.messages.length + quiet.pictures.length > before, 'the stream goes on');
});

test('the camera picture is a JPEG, also without a viewer', async (t) => {
  const server = await startServer(t);
  const admin = await firstAdmin(server);
  await rigIdle(admin);
  const answer = await eventually(() => admin.get('/rigs/rig-1/camera.jpg'), (a) => a.status === 200, { seconds: 5 });
  assert.equal(answer.headers.get('content-type'), 'image/jpeg');
  assert.deepEqual([...answer.body.subarray(0, 2), ...answer.body.subarray(-2)], [0xff, 0xd8, 0xff, 0xd9]);
});

test('viewers come and go, and one who stays misses nothing of the stream', async (t) => {
  const server = await startServer(t);
  const admin = await firstAdmin(server);
  await rigIdle(admin);
  const stays = await watch(admin);
  for (let round = 0; round < 20; ++round) {
    const viewers = await Promise.all(Array.from({ length: 10 }, () => watch(admin)));
    await eventually(() => viewers, (all) => all.every((one) => one.messages[0]?.type === 'hello'), { seconds: 5 });
    // At the moment of a picture: a viewer may end while something is being given to it.
    const pictures = stays.pictures.length;
    await eventually(() => stays.pictures.length, (n) => n > pictures, { seconds: 5, every: 1 });
    viewers.forEach((one, i) => (i % 2 ? one.socket.close() : one.socket.terminate()));
  }
  const pictures = stays.pictures.length;
  await eventually(() => stays.pictures.length, (n) => n > pictures + 5, { seconds: 5 });
  assert.equal((await admin.get('/health')).status, 200);
});
