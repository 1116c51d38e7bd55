/** Text messages of the live stream → a typed union. Pure: the socket is elsewhere. */
import type { Rig, Run } from '../api/types';

export type Vec3 = [number, number, number];
export type Quaternion = [number, number, number, number];
export type PoseStatus = 'tracked' | 'interpolated' | 'lost';

export interface TrailPoint {
  tNs: number;
  p: Vec3;
  /** Empty where the server does not say: there is only one then. */
  object: string;
}

export interface HelloMessage {
  type: 'hello';
  seq: number;
  serverTime: number;
  rig: Rig;
  run: Run | null;
  trail: TrailPoint[];
}

export interface RigMessage {
  type: 'rig';
  seq: number;
  rig: Rig;
}

export interface RunMessage {
  type: 'run';
  seq: number;
  run: Run;
}

export interface PoseMessage {
  type: 'pose';
  seq: number;
  tNs: number;
  object: string;
  status: PoseStatus;
  /** m, lab frame; NaN where it was not seen */
  p: Vec3;
  v: Vec3;
  s: Vec3;
  /** x, y, z, w; null of what is followed without its orientation */
  q: Quaternion | null;
  missed: number;
}

/** A type that this client does not know yet: to be acknowledged and otherwise let be. */
export interface OtherMessage {
  type: 'other';
  seq: number;
}

export type LiveMessage = HelloMessage | RigMessage | RunMessage | PoseMessage | OtherMessage;

/** null for what is no message at all: not JSON, no type, or a known type without its parts. */
export function parseMessage(text: string): LiveMessage | null {
  let json: unknown;
  try {
    json = JSON.parse(text);
  } catch {
    return null;
  }
  if (!isRecord(json) || typeof json['type'] !== 'string') return null;
  const seq = typeof json['seq'] === 'number' ? json['seq'] : 0;
  switch (json['type']) {
    case 'hello': {
      const serverTime = parseTime(json['server_time']);
      if (!isRig(json['rig'])) return null;
      const run = isRun(json['run']) ? json['run'] : null;
      return { type: 'hello', seq, serverTime, rig: json['rig'], run, trail: parseTrail(json['trail']) };
    }
    case 'rig':
      return isRig(json['rig']) ? { type: 'rig', seq, rig: json['rig'] } : null;
    case 'run':
      return isRun(json['run']) ? { type: 'run', seq, run: json['run'] } : null;
    case 'pose':
      return parsePose(json, seq);
    default:
      return { type: 'other', seq };
  }
}

function parsePose(json: Record<string, unknown>, seq: number): PoseMessage | null {
  const { t_ns: tNs, object, status, missed } = json;
  if (typeof tNs !== 'number' || !Number.isFinite(tNs)) return null;
  if (status !== 'tracked' && status !== 'interpolated' && status !== 'lost') return null;
  const p = vec3(json['p']);
  if (status !== 'lost' && !p.every(Number.isFinite)) return null;
  return {
    type: 'pose', seq, tNs, object: String(object ?? ''), status, p, v: vec3(json['v']), s: vec3(json['s']), q: quaternion(json['q']),
    missed: typeof missed === 'number' && missed > 0 ? missed : 0,
  };
}

/** Rows of [t, x, y, z], or an object of such rows for each thing that is followed. */
function parseTrail(value: unknown, object = ''): TrailPoint[] {
  if (isRecord(value)) return Object.entries(value).flatMap(([name, rows]) => (Array.isArray(rows) ? parseTrail(rows, name) : []));
  if (!Array.isArray(value)) return [];
  const trail: TrailPoint[] = [];
  for (const row of value) {
    if (!Array.isArray(row) || typeof row[0] !== 'number') continue;
    const p = vec3(row.slice(1));
    if (p.every(Number.isFinite)) trail.push({ tNs: row[0], p, object: typeof row[4] === 'string' ? row[4] : object });
  }
  return trail;
}

function quaternion(value: unknown): Quaternion | null {
  if (!Array.isArray(value) || value.length !== 4 || !value.every((part) => typeof part === 'number')) return null;
  const [x, y, z, w] = value as Quaternion;
  return Math.abs(Math.hypot(x, y, z, w) - 1) < 0.01 ? [x, y, z, w] : null;
}

function vec3(value: unknown): Vec3 {
  const at = (i: number) => (Array.isArray(value) && typeof value[i] === 'number' ? (value[i] as number) : NaN);
  return [at(0), at(1), at(2)];
}

function parseTime(value: unknown): number {
  return typeof value === 'string' ? Date.parse(value) : NaN;
}

function isRig(value: unknown): value is Rig {
  return isRecord(value) && typeof value['id'] === 'string' && typeof value['state'] === 'string';
}

function isRun(value: unknown): value is Run {
  return isRecord(value) && typeof value['id'] === 'number' && typeof value['state'] === 'string' && isRecord(value['parameters']);
}

function isRecord(value: unknown): value is Record<string, unknown> {
  return typeof value === 'object' && value !== null && !Array.isArray(value);
}
