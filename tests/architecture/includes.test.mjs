// The house stands only while includes point one way. Reads the layers from CMakeLists.txt, so that what is
// built and what is checked cannot drift apart, and holds them against the order set out below.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { test } from 'node:test';

const root = path.resolve(import.meta.dirname ?? path.dirname(new URL(import.meta.url).pathname), '../..');
const read = (file) => readFileSync(path.join(root, file), 'utf8');
const tracked = execFileSync('git', ['ls-files', '--cached', '--others', '--exclude-standard'], { cwd: root, encoding: 'utf8' })
  .split('\n').filter((file) => /\.(cpp|hpp|h)$/.test(file));
const sources = tracked.filter((file) => /^(pipeline|server)\//.test(file));

// Lower ranks know nothing of higher ones; layers of one rank know nothing of each other unless named as an exception.
const rank = {
  'pipeline/core': 0,
  'pipeline/simulate': 1, 'pipeline/sensor': 1, 'pipeline/preprocess': 1, 'pipeline/features': 1,
  'pipeline/motion': 1, 'pipeline/analysis': 1,
  'pipeline/track': 2, 'pipeline/drivers': 2,
  'pipeline/run': 3,
  'server/lab': 4, 'server/experiments': 4, 'server/plots': 4, 'server/net': 4,
  'server/config': 5,
  'server/store': 5, 'server/bus': 5,
  'server/archive': 6, 'server/auth': 6, 'server/live': 6,
  'server/rig': 7, 'server/api': 8, 'server/commands': 9, 'server': 10,
};
// Plain headers that describe a wire: both of its ends read them.
const wires = new Set(['pipeline/drivers/simulated_rig/protocol.hpp']);
const heavy = [/^pcl\//, /^opencv2\//, /^boost\/(beast|asio)/, /^OpenNI\.h$/, /^openni2\//, /^sqlite3\.h$/, /^SQLiteCpp\//, /^CLI\//, /^Driver\/Oni/, /^cairo/];

const layerOf = (file) => {
  const parts = file.split('/');
  if (parts.length === 2) return parts[0];
  return `${parts[0]}/${parts[1]}`;
};

function cmakeLayers() {
  const layers = new Map();
  for (const [, folder, rest] of read('CMakeLists.txt').matchAll(/^kinectlab_layer\((\S+)([^)]*)\)/gm)) {
    const uses = /\bUSES((?: (?:pipeline|server)\/\w+)+)/.exec(rest);
    layers.set(folder, uses ? uses[1].trim().split(' ') : []);
  }
  const drivers = /kinectlab_driver\(simulated_rig USES ([^)]*)\)/.exec(read('pipeline/drivers/CMakeLists.txt'));
  layers.set('pipeline/drivers', [...drivers[1].split(' '), 'pipeline/core']);
  layers.set('server', ['server/commands']);
  return layers;
}

const layers = cmakeLayers();

function below(layer, seen = new Set()) {
  for (const used of layers.get(layer) ?? []) {
    if (!seen.has(used)) below(used, seen.add(used));
  }
  return seen;
}

function includes(file) {
  return [...read(file).matchAll(/^\s*#\s*include\s+([<"])([^>"]+)[>"]/gm)].map(([, kind, name]) => ({ own: kind === '"', name }));
}

test('every layer in CMakeLists.txt stands in the order, and uses only what lies below it', () => {
  for (const [layer, uses] of layers) {
    assert.ok(layer in rank, `${layer} has no place in the order`);
    for (const used of uses) {
      assert.ok(rank[used] < rank[layer], `${layer} uses ${used}, which does not lie below it`);
    }
  }
});

test('a file includes only layers that its own layer is linked to', () => {
  const wrong = [];
  for (const file of sources) {
    const layer = layerOf(file);
    const allowed = below(layer).add(layer);
    for (const { own, name } of includes(file)) {
      if (!own || wires.has(name)) continue;
      if (!/^(pipeline|server)\//.test(name)) wrong.push(`${file}: "${name}" is not written from the project's root`);
      else if (!allowed.has(layerOf(name))) wrong.push(`${file}: ${layer} may not include ${name}`);
    }
  }
  assert.deepEqual(wrong, []);
});

test('a wire header includes nothing of the project', () => {
  for (const file of wires) assert.deepEqual(includes(file).filter((one) => one.own), []);
});

test('no circle of includes among files', () => {
  const state = new Map();
  const visit = (file, trail) => {
    if (state.get(file) === 'done' || !tracked.includes(file)) return;
    assert.notEqual(state.get(file), 'open', `circle: ${[...trail, file].join(' → ')}`);
    state.set(file, 'open');
    for (const { own, name } of includes(file)) if (own) visit(name, [...trail, file]);
    state.set(file, 'done');
  };
  for (const file of tracked) visit(file, []);
});

test('heavy headers stay in .cpp files', () => {
  const wrong = [];
  for (const file of tracked.filter((one) => /\.(hpp|h)$/.test(one))) {
    for (const { name } of includes(file)) {
      // A plug-in's classes derive from OpenNI2's; nobody outside its folder sees them.
      if (file.startsWith('pipeline/drivers/') && /^Driver\/Oni/.test(name)) continue;
      if (heavy.some((pattern) => pattern.test(name))) wrong.push(`${file} includes ${name}`);
    }
  }
  assert.deepEqual(wrong, []);
});

test('OpenNI.h is included by one file of the program', () => {
  const users = sources.filter((file) => includes(file).some(({ name }) => /(^|\/)OpenNI\.h$/.test(name)));
  assert.ok(users.length <= 1, `several: ${users.join(', ')}`);
});

test('the pipeline knows no JSON text, network, SQL or log', () => {
  const wrong = [];
  for (const file of sources.filter((one) => one.startsWith('pipeline/'))) {
    for (const { name } of includes(file)) {
      const json = /^nlohmann\//.test(name) && !(file.startsWith('pipeline/sensor/') && file.endsWith('.cpp')); // camera.json
      if (json || /^(spdlog|boost\/asio|boost\/beast|SQLiteCpp|sqlite3)/.test(name)) wrong.push(`${file} includes ${name}`);
    }
  }
  assert.deepEqual(wrong, []);
});
