// A page that points to a file which is not there misleads: every relative link of every page in the project is followed.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { test } from 'node:test';

const root = path.resolve(path.dirname(new URL(import.meta.url).pathname), '../..');
const pages = execFileSync('git', ['ls-files', '--cached', '--others', '--exclude-standard', '*.md'], { cwd: root, encoding: 'utf8' })
  .split('\n').filter((file) => file && existsSync(path.join(root, file)));

const cellsOf = (line) => line.split(/(?<!\\)\|/).map((one) => one.trim());
const linksOf = (page) => [...readFileSync(path.join(root, page), 'utf8').matchAll(/\]\(([^)\s]+)\)/g)]
  .map(([, link]) => link).filter((link) => !/^([a-z]+:|#)/i.test(link));

test('relative links of all pages lead somewhere', () => {
  const broken = pages.flatMap((page) => linksOf(page)
    .filter((link) => !existsSync(path.resolve(root, path.dirname(page), decodeURI(link.split('#')[0]))))
    .map((link) => `${page}: ${link}`));
  assert.deepEqual(broken, []);
});

test('every method of the catalogue is linked to its file, its test and its benchmark', () => {
  for (const page of ['pipeline/README.md', 'pipeline/preprocess/README.md', 'pipeline/track/README.md']) {
    const lines = readFileSync(path.join(root, page), 'utf8').split('\n');
    const start = lines.findIndex((line) => line.startsWith('| method |'));
    const columns = cellsOf(lines[start]);
    for (const wanted of ['file', 'cost', 'accuracy', 'source', 'test', 'benchmark']) {
      assert.ok(columns.some((one) => one.startsWith(wanted)), `${page}: the catalogue has no column "${wanted}"`);
    }
    for (let i = start + 2; lines[i]?.startsWith('|'); ++i) {
      const cells = cellsOf(lines[i]);
      assert.equal(cells.length, columns.length, `${page}: ${lines[i]}`);
      cells.slice(1, -1).forEach((cell, k) => assert.notEqual(cell, '', `${page}: ${cells[1]} has no ${columns[k + 1]}`));
      for (const linked of ['file', 'test', 'benchmark']) {
        const k = columns.findIndex((one) => one.startsWith(linked));
        assert.match(cells[k], /\]\(/, `${page}: ${cells[1]} links to no ${linked}`);
      }
    }
  }
});
