import assert from 'node:assert/strict';
import net from 'node:net';
import { test } from 'node:test';
import { assertProblem, Client } from './client.mjs';
import { sleep } from './laboratory.mjs';
import { startServer } from './server.mjs';

/** Sends bytes, reads until the server closes or falls silent. */
function talk(server, text, { wait = 1500 } = {}) {
  return new Promise((resolve) => {
    const socket = net.connect(server.port, '127.0.0.1', () => socket.write(text));
    let answer = '';
    const timer = setTimeout(() => socket.destroy(), wait);
    socket.on('data', (chunk) => (answer += chunk));
    socket.on('error', () => {});
    socket.on('close', () => { clearTimeout(timer); resolve(answer); });
  });
}
const statuses = (answer) => [...answer.matchAll(/HTTP\/1\.1 (\d+) /g)].map((match) => Number(match[1]));
const get = (path, more = '') => `GET ${path} HTTP/1.1\r\nHost: x\r\n${more}\r\n`;
const health = '/api/v1/health';

test('requests one behind the other are answered in order', async (t) => {
  const server = await startServer(t);
  const answer = await talk(server, get(health) + get('/api/v1/nothing') + get(health, 'Connection: close\r\n'));
  assert.deepEqual(statuses(answer), [200, 404, 200]);
});

test('a HEAD has the header of the GET and no body', async (t) => {
  const server = await startServer(t);
  const answer = await talk(server, `HEAD ${health} HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n`);
  assert.deepEqual(statuses(answer), [200]);
  const length = Number(/Content-Length: (\d+)/.exec(answer)[1]);
  assert.ok(length > 0 && answer.endsWith('\r\n\r\n'));
});

test('what is no HTTP gets 400 and the connection ends', async (t) => {
  const server = await startServer(t);
  for (const text of [
    'hello\r\n\r\n',
    'GET health HTTP/1.1\r\nHost: x\r\n\r\n',
    'GET /a%zz HTTP/1.1\r\nHost: x\r\n\r\n',
    `GET ${health} HTTP/1.1\r\n\r\n`,
    `GET ${health} HTTP/1.1\r\nHost: x\r\nHost: y\r\n\r\n`,
    'POST /api/v1/session HTTP/1.1\r\nHost: x\r\nContent-Length: 5\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n',
    'POST /api/v1/session HTTP/1.1\r\nHost: x\r\nContent-Length: -1\r\n\r\n',
    'POST /api/v1/session HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n',
  ]) {
    const answer = await talk(server, text);
    assert.deepEqual(statuses(answer), [400], text);
    assert.match(answer, /application\/problem\+json/);
  }
  assert.equal((await new Client(server).get('/health')).status, 200);
});

test('bodies and headers are bounded', async (t) => {
  const server = await startServer(t);
  const post = (length, body) => `POST /api/v1/session HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\nContent-Length: ${length}\r\n\r\n${body}`;
  assert.deepEqual(statuses(await talk(server, post(70_000, 'x'.repeat(70_000)))), [413]);
  assert.deepEqual(statuses(await talk(server, post(10 ** 15, ''))), [413]);
  const chunks = `${'10000\r\n'}${'x'.repeat(65_536)}\r\n`.repeat(3);
  assert.deepEqual(statuses(await talk(server, `POST /api/v1/session HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n${chunks}0\r\n\r\n`)), [413]);
  assert.deepEqual(statuses(await talk(server, get(health, `X: ${'a'.repeat(20_000)}\r\n`))), [431]);
  assert.deepEqual(statuses(await talk(server, get(`/${'a'.repeat(20_000)}`))), [431]);
});

test('every answer forbids what a page does not need', async (t) => {
  const server = await startServer(t);
  for (const path of [health, '/api/v1/nothing', '/api/v1/rigs', '/']) {
    const { headers } = await fetch(server.url + path);
    const policy = headers.get('content-security-policy');
    assert.ok(policy.includes("default-src 'self'") && !policy.includes('unsafe'), policy);
    assert.equal(headers.get('x-content-type-options'), 'nosniff');
    assert.ok(headers.get('x-request-id'));
  }
});

test('no address leads out of the web folder', async (t) => {
  const server = await startServer(t);
  for (const path of ['/../../CMakeCache.txt', '/%2e%2e/%2e%2e/CMakeCache.txt', '/..%2f..%2fCMakeCache.txt', '/assets/..%5c..%5cx.txt',
    '/%2fetc%2fpasswd.txt', '//etc/passwd.txt', '/.git/config.txt', '/assets/%00.js']) {
    const answer = await talk(server, get(path, 'Connection: close\r\n'));
    assert.ok([400, 404].includes(statuses(answer)[0]), `${path}: ${answer.slice(0, 40)}`);
  }
});

test('a flood of idle connections does not keep others out', async (t) => {
  const server = await startServer(t);
  const sockets = Array.from({ length: 400 }, () => net.connect(server.port, '127.0.0.1').on('error', () => {}));
  t.after(() => sockets.forEach((socket) => socket.destroy()));
  await sleep(500);
  const turnedAway = sockets.filter((socket) => socket.destroyed || socket.readyState !== 'open' || socket.bytesRead > 0).length;
  assert.ok(turnedAway >= 400 - 256, `${turnedAway} turned away`);
  sockets.slice(0, 300).forEach((socket) => socket.destroy());
  await sleep(300);
  assertProblem(await new Client(server).get('/session'), 401);
});
