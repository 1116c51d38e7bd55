import assert from 'node:assert/strict';
import { test } from 'node:test';
import { assertProblem, Client, firstAdmin, newPassword, person } from './client.mjs';
import { runProgram, startServer, temporaryFolder } from './server.mjs';

test('the first administrator replaces the one-time password', async (t) => {
  const server = await startServer(t);
  assert.match(server.password, /^[a-z2-9]{4}(-[a-z2-9]{4}){3}$/);
  const admin = new Client(server);
  assertProblem(await admin.get('/session'), 401);

  const session = await admin.signIn('admin', server.password);
  assert.equal(session.status, 200);
  assert.equal(session.body.user.must_change_password, true);
  const cookie = session.headers.get('set-cookie');
  for (const part of ['HttpOnly', 'SameSite=Strict', 'Path=/api/v1']) assert.ok(cookie.includes(part), cookie);

  assertProblem(await admin.get('/rigs'), 403);
  assertProblem(await admin.put('/session/password', { current: 'wrong wrong', new: newPassword }), 422, 'current');
  assertProblem(await admin.put('/session/password', { current: server.password, new: 'short' }), 422, 'new');
  assertProblem(await admin.put('/session/password', { current: server.password, new: server.password }), 422, 'new');
  const changed = await admin.put('/session/password', { current: server.password, new: newPassword });
  assert.equal(changed.body.user.must_change_password, false);
  assert.equal((await admin.get('/rigs')).status, 200);

  const other = new Client(server);
  assertProblem(await other.signIn('admin', server.password), 401);
  assert.equal((await other.signIn('ADMIN', newPassword)).status, 200);
  assert.equal((await other.delete('/session')).status, 204);
  assertProblem(await other.get('/session'), 401);
  assert.ok(!server.log.includes(server.password) && !server.log.includes(newPassword), 'a password is in the log');
});

test('there is an administrator also where somebody else was added first', async (t) => {
  const data = await temporaryFolder(t);
  for (const name of ['alice', 'admin']) {
    assert.equal((await runProgram(['user', 'add', name, '--role', 'student', '--data', data])).code, 0);
  }
  const server = await startServer(t, { data });
  const session = await new Client(server).signIn('admin-2', server.password);
  assert.equal(session.body.user?.role, 'admin', JSON.stringify(session.body));
});

test('a new password ends the other sessions', async (t) => {
  const server = await startServer(t);
  const admin = await firstAdmin(server);
  const elsewhere = new Client(server);
  await elsewhere.signIn('admin', newPassword);
  await admin.put('/session/password', { current: newPassword, new: 'another long one' });
  assertProblem(await elsewhere.get('/session'), 401);
  assert.equal((await admin.get('/session')).status, 200);
});

test('wrong passwords are throttled for their account, and for nobody else', async (t) => {
  const server = await startServer(t);
  const admin = await firstAdmin(server);
  await person(admin, 'victim');
  await person(admin, 'bystander');

  const guesser = new Client(server);
  const answers = await Promise.all(Array.from({ length: 12 }, (_, i) => guesser.signIn('victim', `guess number ${i}`)));
  const refused = answers.filter((answer) => answer.status === 429);
  assert.equal(answers.filter((answer) => answer.status === 401).length, 5);
  assert.equal(refused.length, 7);
  for (const answer of refused) assert.ok(Number(answer.headers.get('retry-after')) > 0);
  assertProblem(await guesser.signIn('victim', newPassword), 429);
  assert.equal((await new Client(server).signIn('bystander', newPassword)).status, 200);
  assertProblem(await guesser.signIn('nobody-of-that-name', 'whatever it is'), 401);
});

test('a name that there is takes no longer than one that there is not', async (t) => {
  const server = await startServer(t);
  await firstAdmin(server);
  const timed = async (name) => {
    const start = performance.now();
    assertProblem(await new Client(server).signIn(name, 'a wrong password'), 401);
    return performance.now() - start;
  };
  await timed('warm-up-name');
  const median = (values) => values.sort((a, b) => a - b)[1];
  const there = median([await timed('admin'), await timed('admin'), await timed('admin')]);
  const absent = median([await timed('xa'), await timed('xb'), await timed('xc')]);
  assert.ok(there < 3 * absent && absent < 3 * there, `${there} ms and ${absent} ms`);
});

test('people are added and passwords reset from the command line while the server runs', async (t) => {
  const server = await startServer(t);
  await firstAdmin(server);
  const run = (...args) => runProgram(['user', ...args, '--data', server.data]);
  const added = await run('add', 'ada', '--role', 'instructor', '--name', 'Ada L.');
  assert.equal(added.code, 0, added.stderr);
  const { user, one_time_password: first } = JSON.parse(added.stdout);
  assert.deepEqual([user.username, user.display_name, user.role], ['ada', 'Ada L.', 'instructor']);
  assert.equal((await new Client(server).signIn('ada', first)).status, 200);

  const names = JSON.parse((await run('list')).stdout).users.map((one) => one.username);
  assert.deepEqual(names.sort(), ['ada', 'admin']);
  const reset = JSON.parse((await run('reset', 'ada')).stdout);
  assertProblem(await new Client(server).signIn('ada', first), 401);
  assert.equal((await new Client(server).signIn('ada', reset.one_time_password)).status, 200);

  assert.equal((await run('add', 'ada')).code, 1);
  assert.equal((await run('add', 'Not A Name')).code, 2);
  const role = await run('add', 'bob', '--role', 'king');
  assert.equal(role.code, 2);
  assert.match(role.stderr, /role.*king.*student/s);
});
