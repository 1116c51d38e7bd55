/** What a good run looks like, and whether this one does, in words. */
import type { AcceptanceRule } from '../api/experiment';
import type { AcceptanceCheck, Measurement, Result } from '../api/types';
import { formatQuantity } from './number';
import { forPeople } from './quantity';
import { splitName } from './units';
import { quantityLabel } from './words';

export type Verdict = 'good' | 'not-good' | 'unknown';

/** Results of older programs were never checked: nothing is claimed of them. */
export function verdict(result: Pick<Result, 'accepted' | 'acceptance'>): Verdict {
  if (result.accepted === undefined) return 'unknown';
  return result.accepted ? 'good' : 'not-good';
}

export interface CheckLine {
  label: string;
  ok: boolean;
  found: string;
  wanted: string;
  /** Only where it is missed. */
  reason: string;
}

export function checkLine(check: AcceptanceCheck, results: readonly Measurement[]): CheckLine {
  const show = shower(check.fact, results);
  return {
    label: quantityLabel(check.fact),
    ok: check.ok,
    found: check.value === null ? 'not known' : show(check.value),
    wanted: limits(check.min ?? null, check.max ?? null, show),
    reason: check.ok ? '' : check.reason,
  };
}

/** The same of a definition, before anything was measured: limits are told only where the name says in which unit they are. */
export function ruleLine(rule: AcceptanceRule): { label: string; wanted: string } {
  const told = splitName(rule.fact).unit !== '' || rule.fact.endsWith('_share') || pureNumbers.includes(rule.fact);
  return { label: quantityLabel(rule.fact), wanted: told ? limits(rule.min, rule.max, shower(rule.fact, [])) : '' };
}

const pureNumbers = ['periods', 'reduced_chi2'];

function shower(fact: string, results: readonly Measurement[]): (value: number) => string {
  const measured = results.find((m) => m.name === fact);
  if (measured) {
    return (value) => {
      const shown = forPeople({ name: fact, value, u: 0, unit: measured.unit });
      return formatQuantity(shown.value, shown.unit, 3);
    };
  }
  if (fact.endsWith('_share')) return (value) => formatQuantity(value * 100, '%', 3);
  return (value) => formatQuantity(value, splitName(fact).unit, 3);
}

function limits(min: number | null, max: number | null, show: (value: number) => string): string {
  if (min !== null && max !== null) return `${show(min)} to ${show(max)}`;
  if (min !== null) return `at least ${show(min)}`;
  return max !== null ? `at most ${show(max)}` : '';
}
