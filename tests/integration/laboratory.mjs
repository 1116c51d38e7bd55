// What several tests do in a laboratory: wait, book, run, watch.
import assert from 'node:assert/strict';
import { WebSocket } from './client.mjs';

const block = 300_000;
export const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
export const wireTime = (ms) => new Date(ms).toISOString().replace('.000Z', 'Z');

/** Asks until the answer satisfies; fails with the last answer. */
export async function eventually(ask, satisfied, { seconds = 30, every = 150 } = {}) {
  const deadline = Date.now() + seconds * 1000;
  for (;;) {
    const answer = await ask();
    if (satisfied(answer)) return answer;
    assert.ok(Date.now() < deadline, `not within ${seconds} s: ${String(JSON.stringify(answer)).slice(0, 600)}`);
    await sleep(every);
  }
}

/** A slot that begins `from` blocks after the one that is running. */
export function slot(rig = 'rig-1', from = 0, minutes = 15) {
  const start = Math.floor(Date.now() / block) * block + from * block;
  return { rig, experiment: 'pendulum', start: wireTime(start), end: wireTime(start + minutes * 60_000) };
}

/** Books the slot that is running now. */
export async function bookNow(client, rig = 'rig-1') {
  const answer = await eventually(() => client.post('/bookings', slot(rig)), (a) => a.status !== 422, { seconds: 2 });
  assert.equal(answer.status, 201, JSON.stringify(answer.body));
  return answer.body;
}

export const rigIdle = (client, rig = 'rig-1') =>
  eventually(async () => (await client.get(`/rigs/${rig}`)).body, (r) => r.state === 'idle', { seconds: 40 });

export const runReaches = (client, id, states, seconds = 60) =>
  eventually(async () => (await client.get(`/runs/${id}`)).body, (run) => states.includes(run.state), { seconds });

/** Books, prepares, releases; comes back when the run measures. */
export async function measuringRun(client, parameters = { duration_s: 10 }, rig = 'rig-1') {
  await rigIdle(client, rig);
  await bookNow(client, rig);
  const made = await client.post('/runs', { rig, experiment: 'pendulum', parameters });
  assert.equal(made.status, 201, JSON.stringify(made.body));
  assert.equal(made.body.release_until, null);
  const ready = await runReaches(client, made.body.id, ['ready']);
  const left = Date.parse(ready.release_until) - Date.now();
  assert.ok(left > 0 && left <= 300_000, `to be released until ${ready.release_until}`);
  const released = await client.post(`/runs/${made.body.id}/release`);
  assert.equal(released.status, 200, JSON.stringify(released.body));
  assert.equal(released.body.release_until, null);
  await runReaches(client, made.body.id, ['measuring']);
  return made.body.id;
}

/** Opens the live stream; collects what comes, acknowledging it unless told not to. */
export async function watch(client, rig = 'rig-1', { acknowledge = true } = {}) {
  const ticket = (await client.post(`/rigs/${rig}/live-ticket`)).body.ticket;
  const socket = new WebSocket(`${client.server.url.replace('http', 'ws')}/api/v1/rigs/${rig}/live?ticket=${ticket}`);
  const viewer = { socket, messages: [], pictures: [], closed: undefined };
  socket.on('message', (data, binary) => {
    if (binary) return viewer.pictures.push(data);
    const message = JSON.parse(data);
    viewer.messages.push(message);
    if (acknowledge) socket.send(JSON.stringify({ ack: message.seq }));
  });
  socket.on('close', (code) => (viewer.closed = code));
  viewer.of = (type) => viewer.messages.filter((message) => message.type === type);
  await new Promise((resolve, reject) => socket.on('open', resolve).on('error', reject));
  return viewer;
}
