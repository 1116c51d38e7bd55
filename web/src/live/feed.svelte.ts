/** A rig as its viewers see it: what changes rarely is reactive state; what comes 30 times a second
 * is kept in memory that the drawing code reads at each animation frame. */
import * as lab from '../api/lab';
import { ApiError } from '../api/problem';
import type { Rig, Run } from '../api/types';
import { SlidingColumns } from '../models/ring';
import { isOlder } from '../models/run_phase';
import { LiveConnection, type ConnectionState } from './connection';
import type { LiveMessage, PoseMessage } from './messages';
import type { Picture } from './picture';

/** Columns of the history. */
export const T = 0;
export const X = 1;
export const Y = 2;
export const Z = 3;

/** Two minutes at 30 Hz. */
const capacity = 3600;

export class RigFeed {
  connection = $state<ConnectionState>('connecting');
  /** When the next attempt is made, ms since the epoch. */
  nextAttempt = $state(0);
  rig = $state<Rig | null>(null);
  run = $state<Run | null>(null);
  failure = $state<ApiError | null>(null);
  /** Poses that this viewer did not get since the page was opened. */
  missed = $state(0);

  /** Server clock minus ours, ms. */
  clockOffset = $state(0);

  /** What has been seen, in the order in which it was. */
  objects = $state.raw<readonly string[]>([]);
  /** Of each object t (s since the first of all), x, y, z (m). */
  readonly histories = new Map<string, SlidingColumns>();
  /** The newest pose of each object. */
  readonly poses = new Map<string, PoseMessage>();
  /** Grows with each change of the histories. */
  version = 0;
  picture: Picture | null = null;

  private originNs = NaN;
  /** Capture of the newest thing seen, ms on the server's clock. */
  private newest = NaN;
  private readonly link: LiveConnection;

  constructor(rigId: string) {
    this.link = new LiveConnection({
      open: async () => {
        const { ticket } = await lab.liveTicket(rigId);
        const url = new URL(lab.liveUrl(rigId, ticket), location.href);
        url.protocol = url.protocol.replace('http', 'ws');
        return new WebSocket(url);
      },
      onMessage: (message) => this.receive(message),
      onPicture: (picture) => {
        this.picture = picture;
        this.seen(picture.t);
      },
      onState: (state, delay) => {
        this.connection = state;
        this.nextAttempt = Date.now() + delay;
      },
      isFinal: (error) => error instanceof ApiError && [401, 403, 404].includes(error.status),
      onFinal: (error) => (this.failure = error as ApiError),
    });
  }

  start(): () => void {
    const online = () => this.link.retryNow();
    const offline = () => this.link.drop();
    addEventListener('online', online);
    addEventListener('offline', offline);
    this.link.start();
    return () => {
      removeEventListener('online', online);
      removeEventListener('offline', offline);
      this.link.close();
    };
  }

  retryNow(): void {
    this.link.retryNow();
  }

  /** How old the newest picture or pose is, ms; NaN before the first. */
  age(): number {
    return Date.now() + this.clockOffset - this.newest;
  }

  /** What an answer to a command said; the stream says it too, a little later or a little earlier. */
  adopt(run: Run): void {
    if (!this.run || !isOlder(run, this.run)) this.setRun(run);
  }

  private receive(message: LiveMessage): void {
    switch (message.type) {
      case 'hello':
        if (Number.isFinite(message.serverTime)) this.clockOffset = message.serverTime - Date.now();
        this.rig = message.rig;
        this.run = message.run;
        this.restart();
        for (const point of message.trail) this.append(point.object, point.tNs, point.p);
        break;
      case 'rig':
        this.rig = message.rig;
        break;
      case 'run':
        this.setRun(message.run);
        break;
      case 'pose':
        this.missed += message.missed;
        this.poses.set(message.object, message);
        this.append(message.object, message.tNs, message.p);
        this.seen(message.tNs / 1e6);
        break;
      case 'other':
        break;
    }
  }

  private setRun(run: Run): void {
    const released = run.state === 'measuring' && this.run?.state !== 'measuring';
    if (released || run.id !== this.run?.id) this.restart();
    this.run = run;
  }

  private restart(): void {
    this.histories.clear();
    this.poses.clear();
    this.objects = [];
    this.originNs = NaN;
    this.version += 1;
  }

  private append(object: string, tNs: number, p: readonly number[]): void {
    if (Number.isNaN(this.originNs)) this.originNs = tNs;
    const t = (tNs - this.originNs) / 1e9;
    const history = this.historyOf(object);
    // Time runs forward only; a repeated message changes nothing.
    if (history.length > 0 && t <= history.last(T)) return;
    history.push(t, p[0] ?? NaN, p[1] ?? NaN, p[2] ?? NaN);
    this.version += 1;
  }

  private historyOf(object: string): SlidingColumns {
    let history = this.histories.get(object);
    if (history) return history;
    // A path without a name belongs to the one thing that is followed.
    history = this.histories.get('') ?? new SlidingColumns(4, capacity);
    this.histories.delete('');
    this.histories.set(object, history);
    this.objects = [...this.histories.keys()];
    return history;
  }

  private seen(t: number): void {
    if (!(t <= this.newest)) this.newest = t;
  }
}
