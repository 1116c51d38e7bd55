import assert from 'node:assert/strict';
import { test } from 'node:test';
import { assertProblem, Client, firstAdmin, person } from './client.mjs';
import { bookNow, rigIdle, slot, wireTime } from './laboratory.mjs';
import { startServer } from './server.mjs';

test('whatever is wrong with a booking is named, and nothing is stored', async (t) => {
  const server = await startServer(t);
  const student = await person(await firstAdmin(server), 'student');
  const good = slot('rig-1', 6);
  const at = (ms) => wireTime(Date.parse(good.start) + ms);
  const wrong = [
    [{ ...good, start: at(60_000) }, 'start'],
    [{ ...good, end: at(61_000) }, 'end'],
    [{ ...good, end: good.start }, 'end'],
    [{ ...good, end: at(-300_000) }, 'end'],
    [{ ...good, end: at(3 * 3_600_000) }, 'end'],
    [{ ...good, start: at(-86_400_000), end: at(-86_100_000) }, 'start'],
    [{ ...good, start: at(40 * 86_400_000), end: at(40 * 86_400_000 + 600_000) }, undefined],
    [{ ...good, start: '2026-02-30T10:00:00Z' }, 'start'],
    [{ ...good, start: 'tomorrow' }, 'start'],
    [{ ...good, start: '2026-12-01T10:00:00' }, 'start'],
    [{ ...good, start: 5 }, 'start'],
    [{ ...good, rig: 'rig-9' }, 'rig'],
    [{ ...good, rig: ['rig-1'] }, 'rig'],
    [{ ...good, experiment: 'volcano' }, 'experiment'],
    [{ ...good, colour: 'red' }, 'colour'],
    [{ rig: 'rig-1', experiment: 'pendulum', start: good.start }, 'end'],
    [[good], 'body'],
    [null, 'body'],
  ];
  for (const [body, field] of wrong) assertProblem(await student.post('/bookings', body === null ? 'null' : body), 422, field);
  assert.deepEqual((await student.get('/bookings')).body.bookings, []);
});

test('what is no JSON object is refused before it is looked at', async (t) => {
  const server = await startServer(t);
  const client = new Client(server);
  const raw = (text, type = 'application/json') => client.request('POST', '/session', text, { headers: { 'Content-Type': type } });
  assertProblem(await raw('{"username":'), 400, 'body');
  assertProblem(await raw(''), 400, 'body');
  assertProblem(await raw('{"username":"a","username":"b","password":"c"}'), 400, 'body');
  assertProblem(await raw('['.repeat(30_000)), 400, 'body');
  assertProblem(await raw(`${'['.repeat(200)}${']'.repeat(200)}`), 400, 'body');
  assertProblem(await raw('{"username":"a","password":"b"}', 'text/plain'), 400, 'Content-Type');
  assertProblem(await raw('username=a&password=b', 'application/x-www-form-urlencoded'), 400, 'Content-Type');
  assertProblem(await client.post('/session', { username: 'a', passwort: 'b' }), 422, 'passwort');
  assertProblem(await client.post('/session', { username: 1, password: 'b' }), 422, 'username');
  assertProblem(await client.post('/session', { username: 'a' }), 422, 'password');
});

test('people are checked before they are added', async (t) => {
  const server = await startServer(t);
  const admin = await firstAdmin(server);
  const good = { username: 'ada', display_name: 'Ada', role: 'student' };
  for (const [change, field] of [
    [{ username: 'A B' }, 'username'],
    [{ username: 'a' }, 'username'],
    [{ username: `a${'b'.repeat(40)}` }, 'username'],
    [{ username: "a'; drop table users; --" }, 'username'],
    [{ display_name: '' }, 'display_name'],
    [{ display_name: 'two\nlines' }, 'display_name'],
    [{ display_name: 'x'.repeat(65) }, 'display_name'],
    [{ role: 'king' }, 'role'],
    [{ role: null }, 'role'],
  ]) {
    assertProblem(await admin.post('/users', { ...good, ...change }), 422, field);
  }
  assert.equal((await admin.get('/users')).body.users.length, 1);
  assert.equal((await admin.post('/users', good)).status, 201);
  assertProblem(await admin.post('/users', good), 409, 'username');
});

test('a run needs a booking, and parameters within their ranges', async (t) => {
  const server = await startServer(t);
  const admin = await firstAdmin(server);
  const student = await person(admin, 'student');
  await rigIdle(student);
  const start = (parameters, more = {}) => student.post('/runs', { rig: 'rig-1', experiment: 'pendulum', parameters, ...more });
  const unbooked = await start({});
  assert.ok([403, 409].includes(unbooked.status), JSON.stringify(unbooked.body));
  await bookNow(student);
  for (const [parameters, field] of [
    [{ length_m: 9 }, 'parameters.length_m'],
    [{ length_m: -1 }, 'parameters.length_m'],
    [{ length_m: '1' }, 'parameters.length_m'],
    [{ length_m: null }, 'parameters.length_m'],
    [{ lenght_m: 1 }, 'parameters.lenght_m'],
    [{ duration_s: 1e9 }, 'parameters.duration_s'],
    [{ amplitude_deg: 91 }, 'parameters.amplitude_deg'],
    [5, 'parameters'],
    [[], 'parameters'],
  ]) {
    assertProblem(await start(parameters), 422, field);
  }
  assertProblem(await start({}, { speed: 1 }), 422, 'speed');
  const stranger = await person(admin, 'stranger');
  assertProblem(await stranger.post('/runs', { rig: 'rig-1', experiment: 'pendulum' }), 403);
  assert.deepEqual((await student.get('/runs')).body.runs, []);
});

test('addresses and queries that make no sense', async (t) => {
  const server = await startServer(t);
  const admin = await firstAdmin(server);
  for (const path of ['/rigs/rig-9', '/rigs/rig-9/camera.jpg', '/rigs/rig-9/bookings', '/experiments/volcano', '/runs/99',
    '/runs/abc', '/runs/-1', '/runs/99999999999999999999', '/runs/99/poses', '/runs/99/poses.csv', '/runs/99/fit']) {
    assertProblem(await admin.get(path), 404);
  }
  assertProblem(await admin.get('/runs?limit=0'), 422, 'limit');
  assertProblem(await admin.get('/runs?limit=ten'), 422, 'limit');
  assertProblem(await admin.get('/runs?limit=1&limit=2'), 422, 'limit');
  assertProblem(await admin.get('/runs?rig=nope'), 422, 'rig');
  assertProblem(await admin.get('/runs?before=-3'), 422, 'before');
  assertProblem(await admin.get('/runs?mine=perhaps'), 422, 'mine');
  assertProblem(await admin.get('/runs?user=3'), 422, 'user');
  assertProblem(await admin.post('/runs/99/release'), 404);
  assertProblem(await admin.get('/nothing/here'), 404);
  const other = await admin.request('PATCH', '/bookings', {});
  assertProblem(other, 405);
  assert.equal(other.headers.get('allow'), 'GET, HEAD, POST');
});
