// The command line as a person uses it: the real program, real files, exit status and both streams.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { cpSync, existsSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { after, before, describe, test } from 'node:test';

const root = path.resolve(path.dirname(new URL(import.meta.url).pathname), '../..');
const program = process.env.KINECTLAB_BIN ?? path.join(root, 'build/release/bin/kinectlab');
const shared = process.env.KINECTLAB_SHARED_DATA ?? path.join(root, '../shared/data');
const scratch = mkdtempSync(path.join(tmpdir(), 'kinectlab-cli-'));
after(() => rmSync(scratch, { recursive: true, force: true }));

const kinectlab = (...args) => spawnSync(program, args, { encoding: 'utf8', maxBuffer: 1 << 28 });

function refused(run, status, ...words) {
  assert.equal(run.status, status, run.stderr + run.stdout);
  for (const word of words) assert.match(run.stderr, word);
  assert.equal(run.stdout, '', 'no result beside an error');
}

function json(run) {
  assert.equal(run.status, 0, run.stderr);
  return JSON.parse(run.stdout);
}

function rows(csv) {
  const [head, ...lines] = csv.trimEnd().split('\n').map((line) => line.split(','));
  return lines.map((cells) => Object.fromEntries(head.map((name, i) => [name, cells[i]])));
}

function objects(name, ...list) {
  const file = path.join(scratch, name);
  writeFileSync(file, JSON.stringify({ objects: list }));
  return file;
}

describe('wrong arguments end with status 2 and name what was wrong', () => {
  const out = path.join(scratch, 'never');
  const wrong = [
    [['simulat', 'pendulum'], /simulat/, /did you mean simulate/],
    [[], /command/],
    [['simulate'], /EXPERIMENT/],
    [['simulate', 'pendulum'], /--out/],
    [['simulate', 'pendulm', '--out', out], /pendulm/, /did you mean pendulum/],
    [['simulate', 'pendulum', '--out', ''], /--out/, /give a path/],
    [['simulate', 'pendulum', '--out', out, '--seconds', '-3'], /--seconds/],
    [['simulate', 'pendulum', '--out', out, '--seconds', 'ten'], /--seconds/],
    [['simulate', 'pendulum', '--out', out, '--seconds', 'nan'], /--seconds/, /from 0.1 to 3600/],
    [['simulate', 'pendulum', '--out', out, '--seconds', '0'], /--seconds/, /from 0.1 to 3600/],
    [['simulate', 'pendulum', '--out', out, '--seed', 'x'], /--seed/, /whole number/],
    [['simulate', 'pendulum', '--out', out, '--seed=-1'], /--seed/, /from 0 to/],
    [['simulate', 'pendulum', '--out', out, '--seed', '1.5'], /--seed/, /whole number/],
    [['simulate', 'pendulum', '--out', out, '--seed', '18446744073709551616'], /--seed/, /from 0 to/],
    [['simulate', 'pendulum', '--out', out, '--set', 'amplitude_deg=abc'], /--set amplitude_deg=/],
    [['user', 'add', 'A B', '--data', out], /username/],
    [['user', 'add', 'ada', '--role', 'king', '--data', out], /--role/],
    [['simulate', 'pendulum', '--out', out, '--noise', 'loud'], /noise/, /kinect/],
    [['simulate', 'pendulum', '--out', out, '--set', 'lenght_m=1'], /lenght_m/, /did you mean length_m/],
    [['simulate', 'pendulum', '--out', out, '--set', 'length_m=9'], /length_m: is 9/, /from 0.3 to 1.5/],
    [['simulate', 'pendulum', '--out', out, '--set', 'length_m=nan'], /length_m/],
    [['simulate', 'pendulum', '--out', out, '--set', 'length_m'], /NAME=NUMBER/],
    [['simulate', 'pendulum', '--out', out, '--set', 'length_m=1', '--set', 'length_m=1'], /length_m/, /twice/],
    [['simulate', 'pendulum', '--out', out, '--colour', 'red'], /--colour/],
    [['analyse', 'pendulum', out, '--set', 'gravity=1.62'], /gravity/, /simulation/],
    [['track', out], /--objects/],
    [['track', out, '--objects', path.join(scratch, 'nothing.json')], /nothing\.json/],
    [['track', out, '--objects', objects('wrong.json', { name: 'b', method: 'shpere' })], /objects\[0\]\.method/, /sphere/],
  ];
  for (const [args, ...words] of wrong) {
    test(args.map((arg) => arg.replace(scratch, '')).join(' ') || '(nothing)', () => {
      refused(kinectlab(...args), 2, ...words);
      assert.ok(!existsSync(out), 'nothing was stored');
    });
  }

  test('only looking makes no laboratory', () => {
    refused(kinectlab('user', 'list', '--data', out), 1, /no database/, /--data/);
    refused(kinectlab('user', 'reset', 'ada', '--data', out), 1, /no database/);
    assert.ok(!existsSync(out), 'nothing was stored');
  });

  test('help and version', () => {
    assert.match(kinectlab('--help').stdout, /simulate[\s\S]*track[\s\S]*analyse/);
    assert.match(kinectlab('--version').stdout, /^kinectlab \d+\.\d+\.\d+\n$/);
    for (const command of ['simulate', 'track', 'analyse']) {
      const run = kinectlab(command, '--help');
      assert.equal(run.status, 0);
      assert.match(run.stdout, new RegExp(`kinectlab ${command}`));
    }
  });
});

describe('a simulated pendulum', () => {
  const recording = path.join(scratch, 'recording');
  let summary;
  before(() => {
    summary = json(kinectlab('simulate', 'pendulum', '--out', recording, '--seconds', '12', '--seed', '3',
      '--set', 'length_m=0.9', '--set', 'gravity=9.7'));
  });

  // A copy that differs in one thing.
  function damaged(name, act) {
    const folder = path.join(scratch, name);
    cpSync(recording, folder, { recursive: true });
    act(folder);
    return folder;
  }
  const lines = (folder, list) => readFileSync(path.join(folder, list), 'utf8').trimEnd().split('\n');
  const put = (folder, list, all) => writeFileSync(path.join(folder, list), all.join('\n') + '\n');

  test('tells what it recorded', () => {
    assert.equal(summary.frames, lines(recording, 'depth.txt').length - 1);
    assert.equal(summary.parameters.length_m, 0.9);
    assert.equal(summary.seconds, 12);
    assert.ok(summary.frames >= 360);
  });

  // In a small swing the bob never leaves all of the place where it hung when the scene was learned.
  test('of a small swing gives g as well', () => {
    const small = path.join(scratch, 'small');
    json(kinectlab('simulate', 'pendulum', '--out', small, '--seconds', '10', '--seed', '5', '--set', 'amplitude_deg=1'));
    const g = json(kinectlab('analyse', 'pendulum', small)).results.find(({ name }) => name === 'g');
    assert.ok(g.u < 0.03 && Math.abs(g.value - 9.81) < 5 * g.u, `${g.value} ± ${g.u}`);
  });

  test('does not write over a recording', () => {
    refused(kinectlab('simulate', 'pendulum', '--out', recording, '--seconds', '1'), 1, /recording/, /new folder/);
  });

  test('gives g within five standard uncertainties, with budget and provenance', () => {
    const out = path.join(scratch, 'result');
    const result = json(kinectlab('analyse', 'pendulum', recording, '--set', 'length_m=0.9', '--out', out));
    const g = result.results.find(({ name }) => name === 'g');
    assert.ok(g.u > 0 && g.u < 0.05, `u = ${g.u}`);
    assert.ok(Math.abs(g.value - 9.7) < 5 * g.u, `${g.value} ± ${g.u}`);
    assert.equal(g.unit, 'm/s²');
    assert.equal(g.k, 1);
    const total = Math.hypot(...g.budget.map(({ u }) => u));
    assert.ok(Math.abs(total / g.u - 1) < 0.01, 'the budget adds up');
    assert.equal(result.experiment, 'pendulum');
    assert.equal(result.parameters.length_m, 0.9);
    assert.equal(result.provenance.version, kinectlab('--version').stdout.trim().split(' ')[1]);
    assert.equal(result.provenance.camera.depth.fx, 580);
    assert.deepEqual(JSON.parse(readFileSync(path.join(out, 'result.json'), 'utf8')), result);
    assert.equal(rows(readFileSync(path.join(out, 'poses.csv'), 'utf8')).length, summary.frames);
    assert.match(readFileSync(path.join(out, 'fit.csv'), 'utf8'), /^object,t_ns,x,y,z,fit_x/);
  });

  test('is analysed with the length that its experiment.json tells', () => {
    const result = json(kinectlab('analyse', 'pendulum', recording));
    assert.equal(result.parameters.length_m, 0.9);
    assert.ok(!result.warnings.some((text) => /Earth's ground/.test(text)), 'a set gravity is no surprise');
    assert.equal(result.parameters.gravity, undefined, 'the truth is no parameter of the analysis');
  });

  test('is tracked where it truly was', () => {
    const file = objects('bob.json', { name: 'bob', method: 'sphere', radius_m: 0.05 });
    const run = kinectlab('track', recording, '--objects', file);
    assert.equal(run.status, 0, run.stderr);
    const poses = rows(run.stdout);
    assert.deepEqual(Object.keys(poses[0]), ('t_ns,object,status,x,y,z,qx,qy,qz,qw,sx,sy,sz,vx,vy,vz,wx,wy,wz,'
      + 'srx,sry,srz,radius,s_radius,half_angle,s_half_angle,points,inlier_share,rms_steps').split(','));
    const truth = new Map(lines(recording, 'groundtruth.txt').slice(1).map((line) => {
      const [t, x, y, z] = line.split(' ');
      return [t.replace('.', ''), [x, y, z].map(Number)];
    }));
    const swinging = poses.slice(summary.first_free_frame).filter(({ status }) => status === 'tracked');
    assert.ok(swinging.length > 300, `${swinging.length} frames tracked`);
    const off = swinging.map(({ t_ns, x, y, z }) => {
      const at = truth.get(t_ns);
      return Math.hypot(x - at[0], y - at[1], z - at[2]);
    });
    const rms = Math.sqrt(off.reduce((sum, d) => sum + d * d, 0) / off.length);
    assert.ok(rms < 0.005, `${rms} m`);
  });

  test('has a radius with its uncertainty where none was given, and a quality', () => {
    const track = (bob) => rows(kinectlab('track', recording, '--objects', objects('free.json', bob)).stdout)
      .filter(({ status }) => status === 'tracked');
    const free = track({ name: 'bob', method: 'sphere', min_radius_m: 0.02, max_radius_m: 0.1 });
    assert.ok(free.length > 300);
    for (const { radius, s_radius, half_angle, points, inlier_share, rms_steps } of free) {
      assert.ok(Math.abs(radius - 0.05) < 6 * s_radius && s_radius > 0, `${radius} ± ${s_radius}`);
      assert.equal(half_angle, '');
      assert.ok(points > 100 && inlier_share > 0.5 && rms_steps > 0.1, `${points} ${inlier_share} ${rms_steps}`);
    }
    const known = track({ name: 'bob', method: 'sphere', radius_m: 0.05 });
    assert.ok(known.every(({ radius, srx }) => radius === '' && srx === ''), 'what was given or is not shown is empty');
  });

  const change_with = (name, preprocess) => {
    const file = path.join(scratch, name);
    writeFileSync(file, JSON.stringify({ objects: [{ name: 'moved', method: 'change' }], preprocess }));
    return file;
  };

  // The wall is three metres away, where the noise is as wide as the voxels.
  test('has one thing that moves, for the octree too', () => {
    const csv = path.join(scratch, 'octree.csv');
    const file = change_with('octree.json', { change: { method: 'octree' } });
    const found = json(kinectlab('track', recording, '--objects', file, '--out', csv));
    assert.deepEqual(found.objects.map(({ name }) => name), ['moved-1']);
    assert.ok(found.objects[0].tracked > 0.9 * summary.frames);
  });

  test('says how much a wide smoothing leaves out', () => {
    const file = change_with('wide.json', { smoothing: { method: 'moving_least_squares', radius_m: 0.2 } });
    const brief = damaged('brief', (f) => put(f, 'depth.txt', lines(f, 'depth.txt').slice(0, 37)));
    const run = kinectlab('track', brief, '--objects', file);
    assert.equal(run.status, 0, run.stderr);
    assert.match(run.stderr, /warning: preprocess\.smoothing\.radius_m: is 0\.2 m, which is more than 63 pixels .* nearer than 1\.84 m; \d+ % .* give at most 0\.\d+ m/);
  });

  test('names what a method is called elsewhere', () => {
    const file = change_with('mls.json', { smoothing: { method: 'mls' } });
    refused(kinectlab('track', recording, '--objects', file), 2, /did you mean moving_least_squares\?/);
    const many = change_with('many.json', { outliers: { method: 'statistical', neighbours: 5000 } });
    refused(kinectlab('track', recording, '--objects', many), 2, /is 5000; give .*1 to 4096/);
  });

  test('of a table in capitals is a table', () => {
    const table = path.join(scratch, 'RUN.CSV');
    const row = (i) => [i / 30, 0.17 * Math.cos(3.3 * i / 30), 0].join(',');
    writeFileSync(table, ['t,x,y', ...Array.from({ length: 4 }, (_, i) => row(i))].join('\n'));
    refused(kinectlab('analyse', 'pendulum', table), 1, /RUN\.CSV: has 4 rows/);
  });

  const analyse = (folder, ...args) => kinectlab('analyse', 'pendulum', folder, ...args);
  const pictures = (folder, kind) => readdirSync(path.join(folder, kind)).sort().map((name) => path.join(folder, kind, name));

  test('with a missing picture is an error, never a number', () => {
    const folder = damaged('missing', (f) => rmSync(pictures(f, 'depth')[100]));
    refused(analyse(folder), 1, /depth\.txt:102/, /not there/);
  });
  test('with a missing list', () => {
    refused(analyse(damaged('listless', (f) => rmSync(path.join(f, 'depth.txt')))), 1, /depth\.txt/, /not there/);
  });
  test('with times that run backwards', () => {
    const folder = damaged('backwards', (f) => {
      const all = lines(f, 'depth.txt');
      [all[50], all[51]] = [all[51], all[50]];
      put(f, 'depth.txt', all);
    });
    refused(analyse(folder), 1, /depth\.txt:52/, /increase/);
  });
  test('with a truncated picture', () => {
    const folder = damaged('truncated', (f) => {
      const file = pictures(f, 'depth')[40];
      writeFileSync(file, readFileSync(file).subarray(0, 5000));
    });
    refused(analyse(folder), 1, /\.png/, /PNG/);
  });
  test('with a damaged colour picture that nobody needs is tracked, with a warning', () => {
    const folder = damaged('grey', (f) => {
      const file = pictures(f, 'rgb')[40];
      writeFileSync(file, readFileSync(file).subarray(0, 5000));
    });
    const run = kinectlab('track', folder, '--objects', objects('grey.json', { name: 'bob', method: 'sphere', radius_m: 0.05 }));
    assert.equal(run.status, 0, run.stderr);
    assert.match(run.stderr, /warning: .*rgb.*\.png: .*damaged.*1 of \d+ colour pictures/);
  });
  test('with a picture of another kind', () => {
    const folder = damaged('kind', (f) => cpSync(pictures(f, 'rgb')[40], pictures(f, 'depth')[40]));
    refused(analyse(folder), 1, /\.png/, /16-bit/);
  });
  test('with pictures of another size than the camera', () => {
    const folder = damaged('size', (f) => {
      const camera = JSON.parse(readFileSync(path.join(f, 'camera.json'), 'utf8'));
      writeFileSync(path.join(f, 'camera.json'), JSON.stringify({ ...camera, width: 320, height: 240 }));
    });
    refused(analyse(folder), 1, /640x480/, /320x240/);
  });
  test('with a misspelt key in camera.json', () => {
    const folder = damaged('key', (f) => {
      const text = readFileSync(path.join(f, 'camera.json'), 'utf8');
      writeFileSync(path.join(f, 'camera.json'), text.replace('depth_scale"', 'depth_scal"'));
    });
    refused(analyse(folder), 1, /camera\.json: depth_scal/, /did you mean depth_scale/);
  });
  test('with less than one period', () => {
    const folder = damaged('short', (f) => {
      const all = lines(f, 'depth.txt');
      const start = summary.first_free_frame + 1;
      put(f, 'depth.txt', [all[0], ...all.slice(1, 31), ...all.slice(start, start + 40)]);
    });
    refused(analyse(folder), 1, /period/);
  });
  test('without any motion', () => {
    const folder = damaged('still', (f) => put(f, 'depth.txt', lines(f, 'depth.txt').slice(0, 50)));
    refused(analyse(folder), 1, /./);
  });
  test('that is not there', () => {
    refused(analyse(path.join(scratch, 'nowhere')), 1, /nowhere/, /not there/);
  });
});

const bench = path.join(path.dirname(program), 'bench');
test('the benchmark lists what it can measure', { skip: existsSync(bench) ? false : `no ${bench}` }, () => {
  const list = spawnSync(bench, ['--list'], { encoding: 'utf8' });
  assert.equal(list.status, 0, list.stderr);
  const names = list.stdout.trimEnd().split('\n');
  assert.ok(names.length > 10 && names.includes('octree change'), list.stdout);
  const some = spawnSync(bench, ['--list', '--filter', 'octree'], { encoding: 'utf8' });
  assert.equal(some.stdout, 'octree change\n');
});

describe('real frames', { skip: existsSync(shared) ? false : `no ${shared}` }, () => {
  const change = () => objects('change.json', { name: 'change', method: 'change' });

  test('on xtion_boxes nothing moves in frames 2 to 8, two objects in 9 to 11', () => {
    const csv = path.join(scratch, 'boxes.csv');
    const summary = json(kinectlab('track', path.join(shared, 'xtion_boxes'), '--objects', change(), '--out', csv));
    const moved = Object.fromEntries(summary.moved_per_frame.map(({ frame, moved: n }) => [frame, n]));
    assert.deepEqual(moved, { 1: 0, 2: 0, 3: 0, 4: 0, 5: 0, 6: 0, 7: 0, 8: 0, 9: 2, 10: 2, 11: 2 });
    const poses = rows(readFileSync(csv, 'utf8'));
    assert.deepEqual(poses.map(({ object }) => object).sort(), ['change-1', 'change-1', 'change-1', 'change-2', 'change-2', 'change-2']);
    assert.ok(poses.every(({ status, sx }) => status === 'tracked' && Number(sx) > 0));
  });

  test('an organised cloud is a recording of one frame', () => {
    const csv = path.join(scratch, 'osd.csv');
    const summary = json(kinectlab('track', path.join(shared, 'pcl/osd_test31.pcd'), '--objects', change(), '--out', csv));
    assert.equal(summary.frames, 1);
    assert.deepEqual(summary.moved_per_frame.map(({ moved }) => moved), [0]);
  });

  test('a recording of a Kinect has twelve frames', () => {
    const csv = path.join(scratch, 'oni.csv');
    const summary = json(kinectlab('track', path.join(shared, 'kinect1_oni/test.oni'), '--objects', change(), '--out', csv));
    assert.equal(summary.frames, 12);
  });
});
