/** The settings of an analysis as fields: what was typed → what is sent. */
import type { AnalysisSetting } from '../api/analysis';
import type { FieldError } from '../api/types';
import { formatQuantity, parseDecimal } from './number';
import { splitName } from './units';

export interface ReadSettings {
  /** All of them, so that it does not matter what an earlier version was made with; null: not given. */
  values: Record<string, number | null>;
  errors: FieldError[];
}

export function settingTexts(settings: readonly AnalysisSetting[], now: Record<string, number>): Record<string, string> {
  return Object.fromEntries(settings.map(({ name }) => [name, now[name] === undefined ? '' : String(now[name])]));
}

export function readSettings(settings: readonly AnalysisSetting[], texts: Record<string, string>): ReadSettings {
  const read: ReadSettings = { values: {}, errors: [] };
  for (const s of settings) {
    const field = `settings.${s.name}`;
    const text = (texts[s.name] ?? '').trim();
    const { unit } = splitName(s.name);
    const cure = `give a number from ${formatQuantity(s.min, '1')} to ${formatQuantity(s.max, unit)}`;
    const value = parseDecimal(text);
    if (text === '' && s.required) read.errors.push({ field, message: 'is empty, and nothing can be measured without it', cure });
    else if (text === '') read.values[s.name] = null;
    else if (Number.isNaN(value)) read.errors.push({ field, message: `“${text}” is not a number`, cure });
    else if (value < s.min || value > s.max) read.errors.push({ field, message: `is ${formatQuantity(value, unit)}`, cure });
    else read.values[s.name] = value;
  }
  return read;
}

/** What holds where nothing is given. */
export function withoutIt(s: AnalysisSetting): string {
  if (s.required) return 'needed';
  return s.otherwise === null ? 'may be left empty' : `${formatQuantity(s.otherwise, splitName(s.name).unit)} if empty`;
}
