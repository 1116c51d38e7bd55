/** What a run is doing, said in a sentence, and the one thing to do about it. */
import type { Booking, Rig, Run, RunState } from '../api/types';
import { clockTime, duration, localTimes, minute, second, slotText } from './time';
import { capitalised, inWords, objectsInWords } from './words';
import { bookingInterval } from './slots';

export type Action = 'prepare' | 'release' | 'stop' | 'result' | 'book' | 'wait';
export type Tone = 'calm' | 'ready' | 'active' | 'good' | 'bad';

export interface Phase {
  sentence: string;
  tone: Tone;
  /** What the main button does; `wait` shows it greyed, with its label saying for what. */
  action: Action;
  label: string;
  /** Whether this viewer may end the run without a result. */
  abortable: boolean;
}

export interface Situation {
  rig: Rig;
  /** The rig's newest run, if any. */
  run: Run | null;
  /** The viewer's bookings on this rig. */
  bookings: Booking[];
  /** Whether the viewer may command this run: it is theirs, or they assist. */
  mayCommand: boolean;
  now: number;
  /** As `releaseLeft` tells it. */
  releaseLeft?: number | null;
  /** Whether all this is only what was last known: the stream is gone. */
  lost?: boolean;
  /** What the run's experiment watches; left away where it is not known yet. */
  objects?: readonly string[];
  /** Whether it is drawn aside and held before it moves. */
  held?: boolean;
}

const underWay: RunState[] = ['preparing', 'ready', 'releasing', 'measuring', 'analysing'];

export function isUnderWay(state: RunState): boolean {
  return underWay.includes(state);
}

/** The viewer's slot at this moment. */
export function slotNow(bookings: Booking[], now: number): Booking | null {
  return bookings.find((b) => b.mine && bookingInterval(b).start <= now && now < bookingInterval(b).end) ?? null;
}

export function nextSlot(bookings: Booking[], now: number): Booking | null {
  const later = bookings.filter((b) => b.mine && bookingInterval(b).start > now);
  return later.sort((a, b) => Date.parse(a.start) - Date.parse(b.start))[0] ?? null;
}

export function phaseOf(s: Situation): Phase {
  const phase = knownPhase(s);
  if (!s.lost) return phase;
  // A command may still get through, so the button stays; nothing is claimed of the rig.
  const label = phase.action === 'wait' ? 'Waiting for the connection' : phase.label;
  return { ...phase, label, tone: 'bad', sentence: 'You see what was last known of the rig. What it does now shows when the connection is back.' };
}

/** The run to show: the one that the stream tells of, or else the last one if it ended in the viewer's slot, which the stream
 * forgets over a lost connection. */
export function shownRun(streamed: Run | null, last: Run | null, slot: Booking | null): Run | null {
  return streamed ?? (last && !isUnderWay(last.state) && endedInSlot(last, slot) ? last : null);
}

function knownPhase(s: Situation): Phase {
  if (s.rig.state === 'offline') {
    return wait('bad', 'The rig is switched off or its camera is unplugged. It is tried again by itself; your slot stays yours.', 'Waiting for the rig');
  }
  if (s.run && isUnderWay(s.run.state)) return underWayPhase(s.run, s);

  const slot = slotNow(s.bookings, s.now);
  const ended = s.run && s.mayCommand ? s.run : null;
  if (ended && ended.state === 'completed' && endedInSlot(ended, slot)) {
    return { sentence: 'Done. The result is there.', tone: 'good', action: 'result', label: 'See result', abortable: false };
  }
  if (slot) {
    const left = bookingInterval(slot).end - s.now;
    const yours = `The rig is yours until ${clockTime(bookingInterval(slot).end)}.`;
    const failure = ended && ended.state !== 'completed' && endedInSlot(ended, slot) ? `${endSentence(ended)} ` : '';
    const hurry = left < 2 * minute ? ' Less than two minutes are left: measure briefly.' : ' Choose the settings, then prepare it.';
    return { sentence: failure + yours + hurry, tone: failure ? 'bad' : 'ready', action: 'prepare', label: 'Prepare', abortable: false };
  }
  const next = nextSlot(s.bookings, s.now);
  if (next) {
    const at = bookingInterval(next);
    return wait('calm', `Your slot is ${slotText(at.start, at.end, undefined, s.now)}. Until then you can watch.`, `Starts in ${duration(at.start - s.now)}`);
  }
  return { sentence: 'You are watching. To run the experiment yourself, book a slot.', tone: 'calm', action: 'book', label: 'Book a slot', abortable: false };
}

function underWayPhase(run: Run, s: Situation): Phase {
  const mine = s.mayCommand;
  const names = s.objects ?? [];
  const it = objectsInWords(names);
  const many = names.length > 1;
  const held = s.held ?? false;
  switch (run.state) {
    case 'preparing':
      return { ...wait('active', `The rig is getting ready: it looks at the scene and puts ${it} in place.`, 'Preparing …'), abortable: mine };
    case 'ready': {
      const stands = `${capitalised(it)} ${many ? 'are' : 'is'} ${held ? 'held' : 'ready'}`;
      return mine
        ? { sentence: `${stands}. ${startCall(s.releaseLeft, held)}`, tone: 'ready', action: 'release', label: held ? 'Release' : 'Start', abortable: true }
        : wait('ready', `${stands} and ${many ? 'wait' : 'waits'} to be ${held ? 'released' : 'started'}.`, 'Ready');
    }
    case 'releasing':
      return { ...wait('active', held ? `The rig lets go of ${it} …` : 'The motion starts …', held ? 'Releasing …' : 'Starting …'), abortable: mine };
    case 'measuring': {
      const moves = `${capitalised(it)} ${many ? 'move' : 'moves'} and every frame is measured.`;
      return mine
        ? { sentence: `${moves} Stop when you have seen enough, or let it run to its end.`, tone: 'active', action: 'stop', label: 'Stop', abortable: true }
        : wait('active', moves, 'Measuring');
    }
    default:
      return { ...wait('active', 'The motion is measured. The fit is being made …', 'Analysing …'), abortable: mine };
  }
}

/** How long what is held still waits to be released, ms; null where nothing waits or the server does not say. */
export function releaseLeft(run: Run | null, now: number): number | null {
  const until = run?.state === 'ready' && run.release_until ? Date.parse(run.release_until) : NaN;
  return Number.isFinite(until) ? Math.max(0, until - now) : null;
}

/** Changes once only: it is read out whenever it changes. The seconds are counted beside the button. */
function startCall(left: number | null | undefined, held: boolean): string {
  const start = held ? 'Release' : 'Start';
  return typeof left === 'number' && left <= minute
    ? `${start} within a minute, or the run ends without a measurement.`
    : `${start} when you are ready.`;
}

/** How far the measurement is: seconds done and in all; null while nothing is measured. */
export function progress(run: Run | null, now: number): { done: number; total: number } | null {
  if (run?.state !== 'measuring' || !run.started_at) return null;
  const total = run.parameters['duration_s'] ?? run.duration_s;
  if (!total) return null;
  const done = (now - Date.parse(run.started_at)) / 1000;
  return { done: Math.min(total, Math.max(0, done)), total };
}

/** How a run ended, as a sentence. */
export function endSentence(run: Run): string {
  const why = run.reason ? ` ${sentenceCase(reasonText(run, run.reason))}` : '';
  switch (run.state) {
    case 'completed':
      return 'The run is complete.';
    case 'aborted':
      return `The run was aborted.${why}`;
    case 'failed':
      return `The run failed.${why}`;
    case 'interrupted':
      return `The run was interrupted.${why || ' The laboratory was restarted.'} Nothing is wrong on your side.`;
    default:
      return 'The run is under way.';
  }
}

/** Why it ended, in a student's words. */
function reasonText(run: Run, reason: string): string {
  // The analysis says what it lacks; that somebody pressed Stop is what one can do something about.
  if (run.state === 'failed' && /^samples:/i.test(reason) && stoppedEarly(run)) {
    return 'Stop came too early for a result: measure for longer';
  }
  return localTimes(inWords(reason.replace(/^[a-z]\w*(\.\w+)*: /, '')));
}

function stoppedEarly(run: Run): boolean {
  const wanted = run.parameters['duration_s'] ?? run.duration_s;
  if (!wanted || !run.started_at || !run.ended_at) return false;
  return Date.parse(run.ended_at) - Date.parse(run.started_at) < wanted * second - 2 * second;
}

const stateWords: Record<RunState, string> = {
  preparing: 'Preparing',
  ready: 'Ready to release',
  releasing: 'Releasing',
  measuring: 'Measuring',
  analysing: 'Analysing',
  completed: 'Completed',
  aborted: 'Aborted',
  failed: 'Failed',
  interrupted: 'Interrupted',
};

export const stateWord = (state: RunState): string => stateWords[state] ?? state;

const order = Object.keys(stateWords);

/** Whether `a` tells of an earlier moment than `b`: of an earlier run, or of an earlier state of the same. */
export function isOlder(a: Run, b: Run): boolean {
  return a.id < b.id || (a.id === b.id && order.indexOf(a.state) < order.indexOf(b.state));
}

function endedInSlot(run: Run, slot: Booking | null): boolean {
  return slot !== null && Date.parse(run.created_at) >= bookingInterval(slot).start;
}

function wait(tone: Tone, sentence: string, label: string): Phase {
  return { sentence, tone, action: 'wait', label, abortable: false };
}

function sentenceCase(text: string): string {
  const t = text.trim();
  return t.charAt(0).toUpperCase() + t.slice(1) + (/[.!?]$/.test(t) ? '' : '.');
}
