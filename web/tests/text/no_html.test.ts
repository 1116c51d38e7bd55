import { readdirSync, readFileSync } from 'node:fs';
import { expect, it } from 'vitest';

const source = new URL('../../src/', import.meta.url);
const files = (readdirSync(source, { recursive: true }) as string[]).filter((file) => /\.(svelte|ts)$/.test(file));

it.each(['{@html', 'innerHTML', 'insertAdjacentHTML', 'document.write', 'renderToString'])('no page turns text into HTML by %s', (way) => {
  expect(files.length).toBeGreaterThan(50);
  expect(files.filter((file) => readFileSync(new URL(file, source), 'utf8').includes(way))).toEqual([]);
});
