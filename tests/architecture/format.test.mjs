// One format for everybody, decided by .clang-format.
import assert from 'node:assert/strict';
import { execFileSync, spawnSync } from 'node:child_process';
import path from 'node:path';
import { test } from 'node:test';

const root = path.resolve(path.dirname(new URL(import.meta.url).pathname), '../..');

test('C++ files are formatted', () => {
  const files = execFileSync('git', ['ls-files', '*.cpp', '*.hpp', '*.h'], { cwd: root, encoding: 'utf8' }).split('\n').filter(Boolean);
  const run = spawnSync('clang-format', ['--dry-run', '-Werror', ...files], { cwd: root, encoding: 'utf8' });
  const wrong = [...new Set([...run.stderr.matchAll(/^([^: \n]+):\d+/gm)].map(([, file]) => file))];
  assert.deepEqual(wrong, [], 'clang-format -i mends them');
  assert.equal(run.status, 0, run.stderr);
});
