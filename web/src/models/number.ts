/** Numbers as people read them: a value never without its uncertainty and unit. */

const narrowSpace = '\u202f';
const minus = '\u2212';

export interface UncertainText {
  value: string;
  u: string;
  unit: string;
  /** All in one line: `9.80870 ± 0.00072 m/s²`. */
  text: string;
}

/** Decimals that show `u` with two digits, after rounding: 0.0996 has 0.10 and thus two. */
export function decimalsFor(u: number): number {
  if (!Number.isFinite(u) || u <= 0) return 4;
  const first = Math.floor(Math.log10(u));
  const rounded = Number(u.toPrecision(2));
  const exponent = rounded >= 10 ** (first + 1) ? first + 1 : first;
  return Math.min(12, Math.max(0, 1 - exponent));
}

/** `u` rounded to two digits, the value to the same place. A value that is no number is a dash. */
export function formatUncertain(value: number, u: number, unit: string, locale?: string): UncertainText {
  if (!Number.isFinite(value)) return { value: '–', u: '', unit, text: '–' };
  const decimals = decimalsFor(u);
  const known = Number.isFinite(u) && u > 0;
  const valueText = decimal(value, decimals, locale);
  const uText = known ? decimal(roundToTwoDigits(u), decimals, locale) : '';
  const number = known ? `${valueText}${narrowSpace}±${narrowSpace}${uText}` : valueText;
  const shown = unitText(unit);
  return { value: valueText, u: uText, unit: shown, text: shown ? `${number}${narrowSpace}${shown}` : number };
}

/** A plain number with up to `digits` significant digits and its unit. */
export function formatQuantity(value: number, unit: string, digits = 4, locale?: string): string {
  if (!Number.isFinite(value)) return '–';
  const number = new Intl.NumberFormat(locale, { maximumSignificantDigits: digits, useGrouping: false }).format(value);
  const shown = unitText(unit);
  const joined = shown ? `${number}${narrowSpace}${shown}` : number;
  return joined.replace('-', minus);
}

/** `m/s^2` or `m/s2` → `m/s²`; the unit of a pure number is not written. */
export function unitText(unit: string): string {
  if (unit === '1' || unit === '') return '';
  if (unit === 'deg') return '°';
  return unit.replace(/\^?-1\b/g, '⁻¹').replace(/\^?2\b/g, '²').replace(/\^?3\b/g, '³');
}

/** What somebody typed, with a comma or a point; NaN if it is no number. */
export function parseDecimal(text: string): number {
  const trimmed = text.trim().replace(/[\u2212–]/, '-');
  if (!/^[+-]?(\d+([.,]\d*)?|[.,]\d+)([eE][+-]?\d+)?$/.test(trimmed)) return NaN;
  return Number(trimmed.replace(',', '.'));
}

function roundToTwoDigits(u: number): number {
  return Number(u.toPrecision(2));
}

function decimal(value: number, decimals: number, locale?: string): string {
  return new Intl.NumberFormat(locale, {
    minimumFractionDigits: decimals,
    maximumFractionDigits: decimals,
    useGrouping: false,
  })
    .format(value)
    .replace('-', minus);
}
