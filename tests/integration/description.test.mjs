import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { test } from 'node:test';
import { Client, description } from './client.mjs';
import { startServer } from './server.mjs';

test('the description served is the one in the sources', async (t) => {
  const server = await startServer(t);
  assert.deepEqual((await new Client(server).get('/openapi.json')).body, description);
});

test('the description has the routes of the table, no more and no fewer', async () => {
  const source = await readFile(new URL('../../server/api/routes.cpp', import.meta.url), 'utf8');
  const verbs = { get: 'get', post: 'post', put: 'put', del: 'delete' };
  const table = [...source.matchAll(/Method::(\w+),\s*"([^"]+)"/g)].map(([, verb, path]) => `${verbs[verb]} ${path}`);
  const described = Object.entries(description.paths).flatMap(([path, methods]) => Object.keys(methods).map((method) => `${method} ${path}`));
  assert.ok(table.length > 20);
  assert.deepEqual(described.sort(), table.sort());
});

test('every reference in the description leads somewhere', () => {
  const visit = (node) => {
    if (typeof node !== 'object' || node === null) return;
    if (node.$ref) assert.ok(node.$ref.slice(2).split('/').reduce((at, key) => at?.[key], description), node.$ref);
    Object.values(node).forEach(visit);
  };
  visit(description);
});
