import { describe, expect, it } from 'vitest';
import { parseMessage } from '../../src/live/messages';

const rig = { id: 'rig-1', name: 'Rig 1', state: 'idle', sentence: 'Free', simulated: true, experiments: [], frame_rate_hz: 30, frames_lost: 0, current_run: null };
const run = { id: 3, rig: 'rig-1', state: 'ready', parameters: { length_m: 1 } };
const parse = (value: unknown) => parseMessage(JSON.stringify(value));
const pose = { type: 'pose', seq: 5, t_ns: 1.7e18, object: 'bob', status: 'tracked', p: [0.1, 0, 1], v: [0, 0, 0], s: [0.001, 0.001, 0.001], missed: 0 };

describe('messages', () => {
  it('hello brings the rig, its run and the path so far', () => {
    const hello = parse({ type: 'hello', seq: 1, server_time: '2026-11-22T09:00:00Z', rig, run, trail: [[1e18, 0, 0, 1], [1e18, null, 0, 1], 'x', [1e18, 1]] });
    expect(hello).toMatchObject({ type: 'hello', seq: 1, serverTime: Date.UTC(2026, 10, 22, 9), run: { id: 3 } });
    expect(hello?.type === 'hello' && hello.trail).toEqual([{ tNs: 1e18, p: [0, 0, 1], object: '' }]);
    expect(parse({ type: 'hello', seq: 1, rig, run: null })).toMatchObject({ run: null, trail: [] });
  });

  it('poses that were not seen have no position', () => {
    expect(parse(pose)).toMatchObject({ type: 'pose', seq: 5, p: [0.1, 0, 1], missed: 0 });
    expect(parse({ ...pose, status: 'lost', p: [null, null, null] })).toMatchObject({ status: 'lost', p: [NaN, NaN, NaN] });
    expect(parse({ ...pose, status: 'lost', p: null })).toMatchObject({ p: [NaN, NaN, NaN] });
  });

  it('tell of several objects', () => {
    expect(parse({ ...pose, object: 'ball_b' })).toMatchObject({ object: 'ball_b' });
    const named = parse({ type: 'hello', seq: 1, rig, run, trail: { a: [[1e18, 0, 0, 1]], b: [[1e18, 1, 0, 1]], c: 'x' } });
    expect(named?.type === 'hello' && named.trail.map((point) => [point.object, point.p[0]])).toEqual([['a', 0], ['b', 1]]);
    const rows = parse({ type: 'hello', seq: 1, rig, run, trail: [[1e18, 0, 0, 1, 'a']] });
    expect(rows?.type === 'hello' && rows.trail[0]?.object).toBe('a');
  });

  it('bring an orientation only where there is one', () => {
    expect(parse(pose)).toMatchObject({ q: null });
    expect(parse({ ...pose, q: [0, 0, 0, 1] })).toMatchObject({ q: [0, 0, 0, 1] });
    for (const q of [[0, 0, 0], [0, 0, 0, 0], [0, 0, null, 1], 'up']) expect(parse({ ...pose, q })).toMatchObject({ q: null });
  });

  it('of a kind not known yet are passed on, to be acknowledged', () => {
    expect(parse({ type: 'chat', seq: 9, text: 'hi' })).toEqual({ type: 'other', seq: 9 });
  });

  it.each([
    ['no JSON', '{"type":'],
    ['no object', '[1,2]'],
    ['null', 'null'],
    ['no type', '{"seq":1}'],
    ['a hello without a rig', '{"type":"hello","seq":1}'],
    ['a rig without a state', '{"type":"rig","seq":1,"rig":{"id":"rig-1"}}'],
    ['a run without parameters', '{"type":"run","seq":1,"run":{"id":3,"state":"ready"}}'],
    ['a pose without a time', JSON.stringify({ ...pose, t_ns: 'now' })],
    ['a pose with an unknown status', JSON.stringify({ ...pose, status: 'guessed' })],
    ['a tracked pose without a position', JSON.stringify({ ...pose, p: [1, 2] })],
  ])('that are none give null: %s', (_, text) => {
    expect(parseMessage(text)).toBeNull();
  });
});
