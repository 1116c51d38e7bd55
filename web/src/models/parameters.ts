/** From what somebody typed to the numbers of a run. */
import type { FieldError } from '../api/types';
import type { Parameter } from '../api/experiment';
import { formatQuantity, parseDecimal } from './number';

/** Shown first; the rest is for the curious, under “More settings”. */
const common = ['length_m', 'amplitude_deg', 'gravity', 'duration_s'];

export interface ParameterGroups {
  first: Parameter[];
  more: Parameter[];
}

/** A real rig has no knob for what only a simulation can change. */
export function groupParameters(parameters: Parameter[], simulated: boolean): ParameterGroups {
  const possible = parameters.filter((p) => simulated || !p.simulationOnly);
  const first = common.flatMap((name) => possible.filter((p) => p.name === name));
  const more = possible.filter((p) => !first.includes(p));
  return first.length > 0 ? { first, more } : { first: more, more: [] };
}

/** What the rig has in its stand: as the run under way, or else the last one, set it; what is typed for the next run is not
 * there before Prepare. Without any run it stands as the definition says. */
export function standing(run: { parameters: Record<string, number> } | null, definition: Parameter[]): { length: number; bobRadius: number } {
  const of = (name: string, otherwise: number) =>
    run?.parameters[name] || definition.find((p) => p.name === name)?.default || otherwise;
  return { length: of('length_m', 1), bobRadius: of('bob_radius_m', 0.05) };
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
    const value = parseDecimal(text);
    const cure = `give a number from ${formatQuantity(p.min, '1')} to ${formatQuantity(p.max, p.unit)}`;
    if (Number.isNaN(value)) errors.push({ field: `parameters.${p.name}`, message: text.trim() ? `“${text.trim()}” is not a number` : 'is empty', cure });
    else if (value < p.min || value > p.max) errors.push({ field: `parameters.${p.name}`, message: `is ${formatQuantity(value, p.unit)}`, cure });
    else values[p.name] = value;
  }
  return { values, errors };
}
