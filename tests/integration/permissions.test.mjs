import assert from 'node:assert/strict';
import { test } from 'node:test';
import { assertProblem, Client, description, firstAdmin, person } from './client.mjs';
import { slot } from './laboratory.mjs';
import { startServer } from './server.mjs';

const open = new Set(['getHealth', 'getDescription', 'signIn', 'openLive']);
const operations = Object.entries(description.paths).flatMap(([path, methods]) =>
  Object.entries(methods).map(([method, operation]) => ({ method: method.toUpperCase(), path, operation })),
);
const concrete = (path) => path.slice('/api/v1'.length).replace('{rig}', 'rig-1').replace('{experiment}', 'pendulum').replace(/\{\w+\}/, '1');

test('every route that is not for anybody asks for a session, and every change for its CSRF token', async (t) => {
  const server = await startServer(t);
  const stranger = new Client(server);
  const admin = await firstAdmin(server);
  for (const { method, path, operation } of operations) {
    if (open.has(operation.operationId)) continue;
    assertProblem(await stranger.request(method, concrete(path)), 401);
    if (method === 'GET') continue;
    const wrong = await admin.request(method, concrete(path), undefined, { csrf: 'x'.repeat(43) });
    assertProblem(wrong, 403, 'X-CSRF-Token');
    assertProblem(await admin.request(method, concrete(path), undefined, { csrf: '' }), 403, 'X-CSRF-Token');
  }
  assert.equal((await admin.get('/session')).status, 200, 'the session survived all that');
});

test('each role may do what it may, to its own things and to others', async (t) => {
  const server = await startServer(t);
  const admin = await firstAdmin(server);
  const roles = ['student', 'assistant', 'instructor', 'staff'];
  const people = Object.fromEntries(await Promise.all(roles.map(async (role) => [role, await person(admin, role, role)])));
  for (const role of roles) {
    assertProblem(await people[role].get('/users'), 403);
    assertProblem(await people[role].post('/users', { username: 'eve', display_name: 'Eve', role: 'admin' }), 403);
  }
  const owner = await person(admin, 'owner');
  const booking = (await owner.post('/bookings', slot('rig-1', 12))).body;
  assert.equal(booking.mine, true);

  const seenBy = async (client) => (await client.get('/rigs/rig-1/bookings')).body.bookings.find((one) => one.id === booking.id);
  assert.deepEqual((({ mine, user }) => ({ mine, user }))(await seenBy(people.student)), { mine: false, user: null });
  assert.equal((await seenBy(people.assistant)).user, 'Person owner');
  for (const role of ['student', 'assistant', 'instructor']) assertProblem(await people[role].delete(`/bookings/${booking.id}`), 403);
  assert.equal((await people.staff.delete(`/bookings/${booking.id}`)).status, 204);
  assertProblem(await owner.delete(`/bookings/${booking.id}`), 404);
});
