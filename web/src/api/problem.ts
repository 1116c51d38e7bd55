import { localTimes } from '../models/time';
import { parameterLabel } from '../models/words';
import type { FieldError, Problem, Slot } from './types';

/** The server answered, and said no. `status` 0 means that it could not be reached at all. */
export class ApiError extends Error {
  readonly status: number;
  readonly errors: FieldError[];
  readonly alternatives: Slot[];

  constructor(status: number, message: string, errors: FieldError[] = [], alternatives: Slot[] = []) {
    super(message);
    this.name = 'ApiError';
    this.status = status;
    this.errors = errors;
    this.alternatives = alternatives;
  }
}

const unreachable =
  'The laboratory does not answer. Check your connection; nothing that you entered here is lost.';

/** Sentences for answers that bring no words of their own. */
const fallback: Record<number, string> = {
  401: 'Please sign in first.',
  403: 'This is not yours to do. Ask your instructor if you think it should be.',
  404: 'There is no such thing here. It may have been removed.',
  429: 'That was too often. Wait a minute, then try again.',
  503: 'The rig does not answer at the moment. Try again soon, or choose another rig.',
};

export function offlineError(): ApiError {
  return new ApiError(0, unreachable);
}

/** Reads a problem document; anything else (a proxy's HTML page, an empty body) still gives a sentence. */
export function problemToError(status: number, body: unknown): ApiError {
  const problem: Problem = typeof body === 'object' && body !== null ? (body as Problem) : {};
  const errors = Array.isArray(problem.errors) ? problem.errors.filter(isFieldError).map(withoutCalls) : [];
  const alternatives = Array.isArray(problem.alternatives) ? problem.alternatives.filter(isSlot) : [];
  // The detail is written for a terminal, `field: message; cure`; the parts read better.
  const spoken = errors.map(withSubject).join(' ');
  const message = spoken || (problem.detail && withoutCall(problem.detail)) || fallback[status] || problem.title || `The laboratory answered with error ${status}. Try again.`;
  return new ApiError(status, asSentence(message), errors, alternatives);
}

/** What to show at the field `name`; the server names nested fields `parameters.length_m`. */
export function fieldMessage(error: unknown, name: string): string | null {
  if (!(error instanceof ApiError)) return null;
  const found = error.errors.find((e) => e.field === name);
  if (!found) return null;
  return asSentence(found.cure ? `${found.message}; ${found.cure}` : found.message);
}

/** What to show above the form: all that belongs to none of its fields. */
export function formMessage(error: unknown, fields: string[]): string | null {
  if (!error) return null;
  if (!(error instanceof ApiError)) return error instanceof Error ? error.message : String(error);
  const elsewhere = error.errors.filter((e) => !fields.includes(e.field));
  if (error.errors.length === 0) return error.message;
  return elsewhere.length > 0 ? elsewhere.map(withSubject).join(' ') : null;
}

/** At its field an error needs no subject; elsewhere “is busy” has to say who. */
function withSubject(error: FieldError): string {
  const name = error.field.slice(error.field.lastIndexOf('.') + 1);
  const plain = name === 'user' ? 'Your account' : `The ${name.replaceAll('_', ' ')}`;
  const subject = error.field.startsWith('parameters.') ? parameterLabel(name) : plain;
  const lacksSubject = /^(is|was|has|holds|makes|contains|belongs) /.test(error.message);
  const text = lacksSubject && name ? `${subject} ${error.message}` : error.message;
  return asSentence(error.cure ? `${text}; ${error.cure}` : text);
}

/** `there is no rig 'nope'; GET /api/v1/rigs lists them`: that call helps who writes programs, not who reads pages. */
function withoutCall(text: string): string {
  return text.replace(/;?[^;]*\b(GET|POST|PUT|PATCH|DELETE) \/[^;]*/g, '').trim();
}

function withoutCalls(error: FieldError): FieldError {
  const { cure, ...rest } = error;
  const kept = cure ? withoutCall(cure) : '';
  return kept ? { ...rest, cure: kept } : rest;
}

function asSentence(text: string): string {
  const trimmed = localTimes(text.trim());
  const start = trimmed.charAt(0).toUpperCase() + trimmed.slice(1);
  return /[.!?]$/.test(start) ? start : `${start}.`;
}

function isFieldError(value: unknown): value is FieldError {
  const e = value as FieldError | null;
  return typeof e === 'object' && e !== null && typeof e.field === 'string' && typeof e.message === 'string';
}

function isSlot(value: unknown): value is Slot {
  const s = value as Slot | null;
  return typeof s === 'object' && s !== null && [s.rig, s.start, s.end].every((v) => typeof v === 'string');
}
