import type { BudgetLine, Measurement } from '../api/types';

/** Angles are radians inside the project and degrees where a person reads them. */
export function forPeople(m: Measurement): Measurement {
  const factor = 180 / Math.PI;
  // What turns with the Earth is told in degrees an hour, what turns before one's eyes in degrees a second.
  const slow = Math.max(Math.abs(m.value), m.u) < 1e-3;
  const unit = m.unit === 'rad' ? '°' : m.unit === 'rad/s' ? (slow ? '°/h' : '°/s') : null;
  if (unit === null) return m;
  const scale = unit === '°/h' ? factor * 3600 : factor;
  const scaled: Measurement = { ...m, value: m.value * scale, u: m.u * scale, unit };
  if (m.budget) scaled.budget = m.budget.map((line) => ({ ...line, u: line.u * scale }));
  return scaled;
}

export interface BudgetBar extends BudgetLine {
  /** Of the combined variance, 0 to 1: what one would gain by getting rid of it. */
  share: number;
  /** Of the largest line, 0 to 1: how long its bar is. */
  length: number;
}

/** Largest first. */
export function budgetBars(lines: BudgetLine[]): BudgetBar[] {
  const variance = lines.reduce((sum, line) => sum + line.u * line.u, 0);
  const largest = Math.max(0, ...lines.map((line) => line.u));
  return [...lines]
    .sort((a, b) => b.u - a.u)
    .map((line) => ({
      ...line,
      share: variance > 0 ? (line.u * line.u) / variance : 0,
      length: largest > 0 ? line.u / largest : 0,
    }));
}
