/** What the server says and hears, field for field as in server/api/README.md. Nothing else in the
 * client knows the wire. Times are RFC 3339 in UTC, lengths metres. */

export type Role = 'student' | 'assistant' | 'instructor' | 'staff' | 'admin';

export interface User {
  id: number;
  username: string;
  display_name: string;
  role: Role;
  must_change_password: boolean;
}

export interface Session {
  user: User;
  csrf_token: string;
}

export interface NewUser {
  username: string;
  display_name: string;
  role: Role;
}

export interface CreatedUser {
  user: User;
  one_time_password: string;
}

export interface Rig {
  id: string;
  name: string;
  state: 'idle' | 'busy' | 'offline';
  sentence: string;
  simulated: boolean;
  experiments: string[];
  frame_rate_hz: number;
  frames_lost: number;
  current_run: number | null;
}

export interface Slot {
  rig: string;
  start: string;
  end: string;
}

export interface NewBooking extends Slot {
  experiment: string;
}

export interface Booking extends NewBooking {
  id: number;
  mine: boolean;
  user: string | null;
}

export type RunState =
  | 'preparing'
  | 'ready'
  | 'releasing'
  | 'measuring'
  | 'analysing'
  | 'completed'
  | 'aborted'
  | 'failed'
  | 'interrupted';

export interface BudgetLine {
  source: string;
  u: number;
}

export interface Measurement {
  name: string;
  value: number;
  u: number;
  unit: string;
  k?: number;
  budget?: BudgetLine[];
}

/** One of the checks of what a good run looks like; `reason` is for who missed it. */
export interface AcceptanceCheck {
  fact: string;
  /** null where the run does not tell it. */
  value: number | null;
  min?: number;
  max?: number;
  ok: boolean;
  reason: string;
}

/** Results of older programs lack the optional members. */
export interface Result {
  experiment: string;
  parameters: Record<string, number>;
  results: Measurement[];
  analysis?: { method: string; objects: string[]; settings: Record<string, number> };
  facts?: Record<string, number>;
  acceptance?: AcceptanceCheck[];
  accepted?: boolean;
  warnings?: string[];
  notes?: string[];
  provenance: Record<string, unknown>;
}

export interface Run {
  id: number;
  rig: string;
  experiment: string;
  user: string;
  state: RunState;
  reason: string | null;
  parameters: Record<string, number>;
  created_at: string;
  started_at: string | null;
  ended_at: string | null;
  duration_s: number | null;
  /** When a run that waits in state ready is ended if nobody releases it. */
  release_until?: string | null;
  frames: number;
  frames_lost: number;
  result: Result | null;
  warnings: string[];
}

export interface RunPage {
  runs: Run[];
  next: number | null;
}

export type Column = (number | null)[];

export interface LiveTicket {
  ticket: string;
  expires_at: string;
}

/** RFC 9457 problem document. */
export interface Problem {
  title?: string;
  status?: number;
  detail?: string;
  errors?: FieldError[];
  alternatives?: Slot[];
}

export interface FieldError {
  field: string;
  message: string;
  cure?: string;
}
