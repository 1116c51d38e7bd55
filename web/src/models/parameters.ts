/** From what somebody typed to the numbers of a run. */
import type { FieldError } from '../api/types';
import type { Parameter } from '../api/experiment';
import { formatQuantity, parseDecimal } from './number';
import { duration } from './time';
import { splitName } from './units';

/** How many fields stand open; the rest is for the curious, under “More settings”. */
const openFields = 4;

export interface ParameterGroups {
  first: Parameter[];
  more: Parameter[];
}

/** A real rig has no knob for what only a simulation can change. */
export function groupParameters(parameters: Parameter[], simulated: boolean): ParameterGroups {
  const possible = offeredOn(parameters, simulated).filter((p) => simulated || !p.simulationOnly);
  const duration = possible.filter((p) => p.name === 'duration_s');
  // How well something is known, and what is not given unless one wants to, is for the curious.
  const plain = possible.filter((p) => !duration.includes(p) && p.default !== null && !splitName(p.name).stem.endsWith('_u'));
  const first = [...plain.slice(0, openFields - duration.length), ...duration];
  return { first, more: possible.filter((p) => !first.includes(p)) };
}

/** As a rig offers them: a simulated one knows things of itself that of a real one would be a guess. */
export function offeredOn(parameters: Parameter[], simulated: boolean): Parameter[] {
  return simulated ? parameters.map((p) => ({ ...p, default: p.simulatedDefault ?? p.default })) : parameters;
}

/** The values to begin with; what has no default is not given. */
export function defaultsOf(parameters: Parameter[]): Record<string, number> {
  return Object.fromEntries(parameters.flatMap((p) => (p.default === null ? [] : [[p.name, p.default]])));
}

export function rangeText(p: Parameter): string {
  const low = Number.isFinite(p.min) ? formatQuantity(p.min, '1') : '';
  const high = Number.isFinite(p.max) ? formatQuantity(p.max, '1') : '';
  return low && high ? `${low} to ${high}` : '';
}

export interface ReadParameters {
  values: Record<string, number>;
  errors: FieldError[];
}

/** The same rules as the server's, so that most slips are told before anything is sent. */
export function readParameters(parameters: Parameter[], texts: Record<string, string>): ReadParameters {
  const values: Record<string, number> = {};
  const errors: FieldError[] = [];
  for (const p of parameters) {
    const text = texts[p.name] ?? '';
    if (p.default === null && text.trim() === '') continue;
    const value = parseDecimal(text);
    const cure = `give a number from ${formatQuantity(p.min, '1')} to ${formatQuantity(p.max, p.unit)}`;
    if (Number.isNaN(value)) errors.push({ field: `parameters.${p.name}`, message: text.trim() ? `“${text.trim()}” is not a number` : 'is empty', cure });
    else if (value < p.min || value > p.max) errors.push({ field: `parameters.${p.name}`, message: `is ${formatQuantity(value, p.unit)}`, cure });
    else values[p.name] = value;
  }
  return { values, errors };
}

/** How long a run takes as it is set at first: `measures for 30 s`; empty where the definition does not say. */
export function measuringTime(parameters: Parameter[]): string {
  const seconds = parameters.find((p) => p.name === 'duration_s')?.default;
  return typeof seconds === 'number' ? `measures for ${duration(seconds * 1000)}` : '';
}
