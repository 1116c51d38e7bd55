import { describe, expect, it } from 'vitest';
import type { Booking, Rig, Run, RunState } from '../../src/api/types';
import { endSentence, isOlder, phaseOf, progress, releaseLeft, shownRun, type Situation } from '../../src/models/run_phase';

const now = Date.parse('2026-11-22T09:10:00Z');
const rig: Rig = {
  id: 'rig-1', name: 'Rig 1', state: 'idle', sentence: 'Free', simulated: true, experiments: ['pendulum'], frame_rate_hz: 30, frames_lost: 0,
  current_run: null,
};
const slot: Booking = { id: 1, rig: 'rig-1', experiment: 'pendulum', start: '2026-11-22T09:00:00Z', end: '2026-11-22T09:30:00Z', mine: true, user: null };

function run(state: RunState, more: Partial<Run> = {}): Run {
  return {
    id: 7, rig: 'rig-1', experiment: 'pendulum', user: 'Ada', state, reason: null, parameters: { duration_s: 30 }, created_at: '2026-11-22T09:05:00Z',
    started_at: '2026-11-22T09:09:50Z', ended_at: null, duration_s: 30, frames: 0, frames_lost: 0, result: null, warnings: [], ...more,
  };
}

const situation = (more: Partial<Situation>): Situation => ({ rig, run: null, bookings: [slot], mayCommand: true, now, ...more });
const action = (more: Partial<Situation>) => phaseOf(situation(more)).action;

describe('the one button', () => {
  it('follows the run from prepare to the result', () => {
    expect(action({})).toBe('prepare');
    const states: RunState[] = ['preparing', 'ready', 'releasing', 'measuring', 'analysing', 'completed'];
    expect(states.map((s) => action({ run: run(s) }))).toEqual(['wait', 'release', 'wait', 'stop', 'wait', 'result']);
  });

  it('lets one try again after a run without a result', () => {
    for (const state of ['aborted', 'failed', 'interrupted'] as const) {
      const phase = phaseOf(situation({ run: run(state, { reason: 'the ball was not seen' }) }));
      expect(phase.action).toBe('prepare');
      expect(phase.sentence).toContain('The ball was not seen.');
    }
  });

  it('claims nothing of a rig whose stream is gone', () => {
    const offline = phaseOf(situation({ rig: { ...rig, state: 'offline' }, lost: true }));
    expect([offline.action, offline.label]).toEqual(['wait', 'Waiting for the connection']);
    const measuring = phaseOf(situation({ run: run('measuring'), lost: true }));
    expect(measuring.action).toBe('stop');
    for (const phase of [offline, measuring]) expect(phase.sentence).toMatch(/^You see what was last known/);
  });

  it('shows a run that ended while the connection was gone, if it was in the own slot', () => {
    const ended = run('completed', { ended_at: '2026-11-22T09:10:20Z' });
    expect(shownRun(null, ended, slot)).toBe(ended);
    expect(shownRun(null, run('interrupted'), slot)?.state).toBe('interrupted');
    expect(shownRun(null, run('measuring'), slot)).toBeNull();
    expect(shownRun(null, run('completed', { created_at: '2026-11-22T08:30:00Z' }), slot)).toBeNull();
    expect(shownRun(null, ended, null)).toBeNull();
    const next = run('preparing', { id: 8 });
    expect(shownRun(next, ended, slot)).toBe(next);
  });

  it('begins anew in a slot with the run of another slot on the rig', () => {
    expect(action({ run: run('completed', { created_at: '2026-11-22T08:30:00Z' }) })).toBe('prepare');
  });

  it('shows those who only watch nothing to press but a booking', () => {
    const others = { ...slot, mine: false };
    expect(action({ bookings: [others], mayCommand: false })).toBe('book');
    for (const state of ['ready', 'measuring'] as const) {
      const phase = phaseOf(situation({ bookings: [others], mayCommand: false, run: run(state) }));
      expect(phase.action).toBe('wait');
      expect(phase.abortable).toBe(false);
    }
  });

  it('waits for a slot that is to come, and says for how long', () => {
    const phase = phaseOf(situation({ now: Date.parse('2026-11-22T08:56:00Z') }));
    expect(phase.action).toBe('wait');
    expect(phase.label.replaceAll('\u00a0', ' ')).toBe('Starts in 4 min');
  });

  it('is free again the moment the slot ends', () => {
    expect(action({ now: Date.parse(slot.end) - 1 })).toBe('prepare');
    expect(action({ now: Date.parse(slot.end) })).toBe('book');
  });

  it('waits for a rig that is off, whatever its run says', () => {
    const phase = phaseOf(situation({ rig: { ...rig, state: 'offline' }, run: run('measuring') }));
    expect(phase.action).toBe('wait');
    expect(phase.tone).toBe('bad');
  });

  it('offers to abort while a run is under way, and then only', () => {
    expect(phaseOf(situation({ run: run('measuring') })).abortable).toBe(true);
    expect(phaseOf(situation({ run: run('completed') })).abortable).toBe(false);
  });
});

describe('what is said of a run', () => {
  const sentence = (state: RunState, objects: string[], held: boolean) => phaseOf(situation({ run: run(state), objects, held }));

  it('takes its words from the experiment', () => {
    expect(sentence('ready', ['bob'], true)).toMatchObject({ label: 'Release', sentence: 'The bob is held. Release when you are ready.' });
    expect(sentence('ready', ['ball_a', 'ball_b'], false)).toMatchObject({ label: 'Start', sentence: 'Ball a and ball b are ready. Start when you are ready.' });
    expect(sentence('measuring', ['ball_a', 'ball_b'], false).sentence).toMatch(/^Ball a and ball b move and/);
    expect(sentence('measuring', ['robot'], false).sentence).toMatch(/^The robot moves and/);
  });

  it('stays general while the experiment is not known', () => {
    for (const state of ['preparing', 'ready', 'releasing', 'measuring', 'analysing'] as const) {
      expect(phaseOf(situation({ run: run(state) })).sentence).not.toMatch(/bob|pendulum|swing|magnet/);
    }
  });
});

it('knows how far the measurement is', () => {
  expect(progress(run('measuring'), now)).toEqual({ done: 10, total: 30 });
  expect(progress(run('measuring'), now + 60_000)).toEqual({ done: 30, total: 30 });
  expect(progress(run('ready'), now)).toBeNull();
  expect(progress(null, now)).toBeNull();
});

it('says how a run ended, with the reason as a sentence', () => {
  expect(endSentence(run('failed', { reason: 'fewer than three periods' }))).toBe('The run failed. Fewer than three periods.');
  expect(endSentence(run('interrupted'))).toContain('The laboratory was restarted.');
});

describe('the time to release the bob', () => {
  const until = '2026-11-22T09:15:00Z';

  it('counts down while the bob is held, and only then', () => {
    expect(releaseLeft(run('ready', { release_until: until }), now)).toBe(300_000);
    expect(releaseLeft(run('ready', { release_until: until }), Date.parse(until) + 2000)).toBe(0);
    expect(releaseLeft(run('measuring', { release_until: until }), now)).toBeNull();
    expect(releaseLeft(null, now)).toBeNull();
  });

  it('is not spoken of where the server does not tell it', () => {
    for (const release_until of [null, 'soon']) expect(releaseLeft(run('ready', { release_until }), now)).toBeNull();
    expect(releaseLeft(run('ready'), now)).toBeNull();
  });

  it('changes the sentence once, in the last minute', () => {
    const sentence = (left: number | null) => phaseOf(situation({ run: run('ready'), releaseLeft: left })).sentence;
    expect(sentence(null)).toBe(sentence(299_000));
    expect(sentence(59_000)).toContain('within a minute');
    expect(sentence(1_000)).toBe(sentence(59_000));
  });
});

describe('why a run ended', () => {
  const few = 'samples: the object was seen in 9 of 9 frames; at least 30 are needed, over three periods or more';

  it('says that Stop came too early where it did', () => {
    const early = run('failed', { reason: few, ended_at: '2026-11-22T09:09:52Z' });
    expect(endSentence(early)).toContain('Stop came too early');
    expect(endSentence(early)).not.toMatch(/samples/i);
  });

  it('blames nobody where the run went to its end', () => {
    const whole = run('failed', { reason: few, ended_at: '2026-11-22T09:10:25Z' });
    expect(endSentence(whole)).toContain('The object was seen in 9 of 9 frames');
  });

  it('names no field', () => {
    expect(endSentence(run('failed', { reason: 'parameters.length_m: length_m is not what the arc says' })))
      .toBe('The run failed. The length is not what the arc says.');
  });
});

describe('two tellings of a run', () => {
  it('takes the later moment, whichever comes first', () => {
    expect(isOlder(run('releasing'), run('measuring'))).toBe(true);
    expect(isOlder(run('measuring'), run('releasing'))).toBe(false);
    expect(isOlder(run('ready'), run('ready'))).toBe(false);
    expect(isOlder(run('completed', { id: 6 }), run('preparing'))).toBe(true);
    expect(isOlder(run('preparing', { id: 8 }), run('completed'))).toBe(false);
  });
});
