// Starts the real program on a free port with a data folder of its own.
import { spawn } from 'node:child_process';
import { mkdtemp, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const root = fileURLToPath(new URL('../..', import.meta.url));
export const program = process.env.KINECTLAB_BIN ?? path.join(root, 'build/release/bin/kinectlab');

const simulated = (n) => ({ id: `rig-${n}`, name: `Pendulum ${n}`, uri: `sim://rig-${n}?seed=${n}` });

/** A folder that goes away with the test. */
export async function temporaryFolder(t) {
  const folder = await mkdtemp(path.join(tmpdir(), 'kinectlab-test-'));
  t.after(() => rm(folder, { recursive: true, force: true }));
  return folder;
}

/** Runs the program to its end: {code, stdout, stderr}. */
export function runProgram(args, { env = {} } = {}) {
  const child = spawn(program, args, { env: { ...process.env, ...env } });
  const texts = { stdout: '', stderr: '' };
  child.stdout.on('data', (chunk) => (texts.stdout += chunk));
  child.stderr.on('data', (chunk) => (texts.stderr += chunk));
  return new Promise((resolve, reject) => {
    child.on('error', reject);
    child.on('exit', (code, signal) => resolve({ code, signal, ...texts }));
  });
}

/** A running server. `data` keeps its folder over a restart; the test kills what is left. */
export async function startServer(t, { rigs = 1, data } = {}) {
  const folder = data ?? (await temporaryFolder(t));
  const config = path.join(folder, 'test-config.json');
  const list = Array.from({ length: rigs }, (_, i) => simulated(i + 1));
  await writeFile(config, JSON.stringify({ listen: '127.0.0.1:0', data_dir: '.', rigs: list }));
  const child = spawn(program, ['serve', '--config', config], { stdio: ['ignore', 'pipe', 'pipe'] });
  const server = { data: folder, child, log: '', password: undefined, url: undefined };
  const exited = new Promise((resolve) => child.on('exit', (code, signal) => resolve({ code, signal })));
  server.end = async (signal) => {
    if (child.exitCode === null && child.signalCode === null) child.kill(signal);
    return exited;
  };
  t.after(() => server.end('SIGKILL'));
  child.stderr.on('data', (chunk) => (server.log += chunk));

  await new Promise((resolve, reject) => {
    let text = '';
    const failed = (why) => reject(new Error(`${why}\n${text}\n${server.log}`));
    const timer = setTimeout(() => failed('the server did not start in 30 s'), 30_000);
    child.on('error', reject);
    child.on('exit', () => failed('the server ended'));
    child.stdout.on('data', (chunk) => {
      text += chunk;
      const port = /ready: http:\/\/\S+:(\d+)\n/.exec(text)?.[1];
      if (!port) return;
      clearTimeout(timer);
      server.url = `http://127.0.0.1:${port}`;
      server.port = Number(port);
      // The password comes with the same write, or not at all.
      server.password = /one-time password (\S+)/.exec(text)?.[1];
      resolve();
    });
  });
  return server;
}
