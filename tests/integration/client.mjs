// One person at a browser without the browser. Every answer is checked against the description.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { complaints } from './schema.mjs';

export const WebSocket = createRequire(import.meta.url)('ws');
export const description = JSON.parse(await readFile(new URL('../../server/api/openapi.json', import.meta.url)));

const templates = Object.keys(description.paths).map((path) => ({
  path,
  pattern: new RegExp(`^${path.replaceAll('.', '\\.').replaceAll(/\{\w+\}/g, '[^/]+')}$`),
  parts: path.split('{').length,
}));

function describe(method, path) {
  const bare = path.split('?')[0];
  const fitting = templates.filter((one) => one.pattern.test(bare)).sort((a, b) => a.parts - b.parts)[0];
  return fitting && description.paths[fitting.path][method.toLowerCase()];
}

/** That the answer is one that openapi.json promises. */
function checkAnswer(method, path, status, type, body) {
  const operation = describe(method, path);
  if (!operation) return;
  let promised = operation.responses[status];
  assert.ok(promised, `${method} ${path} answered ${status}, which is not described: ${JSON.stringify(body)}`);
  if (promised.$ref) promised = description.components.responses[promised.$ref.split('/').at(-1)];
  const content = promised.content?.[type.split(';')[0]];
  if (!promised.content) return assert.equal(body, '', `${method} ${path} should have no body`);
  assert.ok(content, `${method} ${path} answered ${type}, which is not described`);
  if (content.schema) assert.deepEqual(complaints(description, content.schema, body), [], `${method} ${path}`);
}

export class Client {
  constructor(server) {
    this.server = server;
    this.cookie = '';
    this.csrf = '';
  }

  /** → {status, headers, body}: parsed where it is JSON. */
  async request(method, path, body, { headers = {}, csrf = this.csrf } = {}) {
    const full = `/api/v1${path}`;
    const sent = { ...headers };
    if (this.cookie) sent.Cookie = this.cookie;
    if (csrf) sent['X-CSRF-Token'] = csrf;
    if (body !== undefined && !('Content-Type' in sent)) sent['Content-Type'] = 'application/json';
    const payload = typeof body === 'string' || body === undefined ? body : JSON.stringify(body);
    const response = await fetch(this.server.url + full, { method, headers: sent, body: payload });
    const type = response.headers.get('content-type') ?? '';
    const binary = type.startsWith('image/');
    const raw = binary ? Buffer.from(await response.arrayBuffer()) : await response.text();
    const parsed = type.includes('json') ? JSON.parse(raw) : raw;
    checkAnswer(method, full, response.status, type, parsed);
    const cookie = /kinectlab_session=[^;]*/.exec(response.headers.get('set-cookie') ?? '')?.[0];
    if (cookie) this.cookie = cookie;
    if (parsed.csrf_token) this.csrf = parsed.csrf_token;
    return { status: response.status, headers: response.headers, body: parsed };
  }

  get(path) { return this.request('GET', path); }
  post(path, body) { return this.request('POST', path, body); }
  put(path, body) { return this.request('PUT', path, body); }
  delete(path) { return this.request('DELETE', path); }

  signIn(username, password) { return this.post('/session', { username, password }); }
}

export const newPassword = 'correct horse battery';

/** The administrator after the first sign-in of all. */
export async function firstAdmin(server) {
  const admin = new Client(server);
  assert.equal((await admin.signIn('admin', server.password)).status, 200);
  const changed = await admin.put('/session/password', { current: server.password, new: newPassword });
  assert.equal(changed.status, 200);
  return admin;
}

/** Somebody with that role, signed in, the one-time password replaced. */
export async function person(admin, username, role = 'student') {
  const added = await admin.post('/users', { username, display_name: `Person ${username}`, role });
  assert.equal(added.status, 201, JSON.stringify(added.body));
  const client = new Client(admin.server);
  await client.signIn(username, added.body.one_time_password);
  const changed = await client.put('/session/password', { current: added.body.one_time_password, new: newPassword });
  assert.equal(changed.status, 200);
  client.user = changed.body.user;
  return client;
}

/** That it is a problem document which names this field and says what would be right. */
export function assertProblem(answer, status, field) {
  assert.equal(answer.status, status, JSON.stringify(answer.body));
  assert.equal(answer.headers.get('content-type'), 'application/problem+json');
  if (field === undefined) return;
  assert.equal(answer.body.errors?.[0]?.field, field, JSON.stringify(answer.body));
  assert.ok(answer.body.errors[0].message.length > 0 && answer.body.errors[0].cure.length > 0);
}
