import assert from 'node:assert/strict';
import { test } from 'node:test';
import { assertProblem, firstAdmin, person } from './client.mjs';
import { slot, wireTime } from './laboratory.mjs';
import { startServer } from './server.mjs';

test('of twenty who want one slot at once, one gets it and the others get alternatives', async (t) => {
  const server = await startServer(t, { rigs: 2 });
  const admin = await firstAdmin(server);
  const people = await Promise.all(Array.from({ length: 5 }, (_, i) => person(admin, `racer${i}`, 'assistant')));
  for (let round = 0; round < 3; ++round) {
    const wanted = slot('rig-1', 10 + 4 * round, 20);
    const answers = await Promise.all(Array.from({ length: 20 }, (_, i) => people[i % 5].post('/bookings', wanted)));
    assert.equal(answers.filter((answer) => answer.status === 201).length, 1);
    const losers = answers.filter((answer) => answer.status === 409);
    assert.equal(losers.length, 19);
    for (const loser of losers) {
      assert.ok(loser.body.alternatives.length > 0);
      assert.equal(loser.body.errors[0].field, 'start');
    }
    const booked = await people[0].post('/bookings', { ...losers[0].body.alternatives[0], experiment: 'pendulum' });
    assert.equal(booked.status, 201, 'an alternative can be booked');
  }
});

test('a booking is listed, cancelled, and its slot is free again', async (t) => {
  const server = await startServer(t);
  const student = await person(await firstAdmin(server), 'student');
  const wanted = slot('rig-1', 6);
  const made = await student.post('/bookings', wanted);
  assert.equal(made.status, 201);
  const { rig, experiment, start, end } = made.body;
  assert.deepEqual({ rig, experiment, start, end }, wanted);
  assert.deepEqual((await student.get('/bookings')).body.bookings, [made.body]);
  assertProblem(await student.post('/bookings', wanted), 409, 'start');
  assert.equal((await student.delete(`/bookings/${made.body.id}`)).status, 204);
  assert.equal((await student.post('/bookings', wanted)).status, 201);

  const from = Date.parse(wanted.start);
  const window = (a, b) => `/rigs/rig-1/bookings?from=${wireTime(from + a)}&to=${wireTime(from + b)}`;
  assert.equal((await student.get(window(0, 60_000))).body.bookings.length, 1);
  assert.equal((await student.get(window(-600_000, 0))).body.bookings.length, 0, 'half-open');
  assertProblem(await student.get(window(0, 63 * 86_400_000)), 422, 'to');
  assertProblem(await student.get(window(0, -1000)), 422, 'to');
  assertProblem(await student.get('/rigs/rig-1/bookings?from=yesterday'), 422, 'from');
});

test('times with any offset mean the same moment', async (t) => {
  const server = await startServer(t);
  const student = await person(await firstAdmin(server), 'student');
  const wanted = slot('rig-1', 6);
  const local = wireTime(Date.parse(wanted.start) + 2 * 3_600_000).replace('Z', '+02:00');
  const made = await student.post('/bookings', { ...wanted, start: local });
  assert.equal(made.status, 201, JSON.stringify(made.body));
  assert.equal(made.body.start, wanted.start);
});
