/** Limits of what moves on the screen: they grow in steps and never jitter. */
import type { Range } from './plot_scale';

/** Null until something was seen. `step` is of the same unit as the values. */
export function grown(range: Range | null, value: number, step: number): Range | null {
  if (!Number.isFinite(value)) return range;
  if (range && value >= range.min && value <= range.max) return range;
  const room = 0.2;
  const low = Math.floor(value / step - room) * step;
  const high = Math.ceil(value / step + room) * step;
  return range ? { min: Math.min(range.min, low), max: Math.max(range.max, high) } : { min: low, max: high };
}

export type Box = [Range, Range, Range];

/** The box around everything, each side in steps of 10 cm. */
export function grownBox(box: Box | null, p: readonly [number, number, number], around: number): Box | null {
  if (!p.every(Number.isFinite)) return box;
  const side = (i: 0 | 1 | 2) => grown(grown(box?.[i] ?? null, p[i] - around, 0.1), p[i] + around, 0.1) as Range;
  const next: Box = [side(0), side(1), side(2)];
  return box && next.every((range, i) => range.min === box[i]?.min && range.max === box[i]?.max) ? box : next;
}
