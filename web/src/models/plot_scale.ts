/** The numbers behind a plot: ranges, ticks, zoom, what is under the pointer. Pure; drawing is elsewhere. */
import type { PlotSeries } from '../api/analysis';
import type { Column } from '../api/types';

export interface Range {
  min: number;
  max: number;
}

export interface View {
  x: Range;
  y: Range;
}

/** Where the axes are, in pixels from the top left. */
export interface Frame {
  left: number;
  top: number;
  width: number;
  height: number;
}

export interface Scale {
  toX: (value: number) => number;
  toY: (value: number) => number;
  fromX: (pixel: number) => number;
  fromY: (pixel: number) => number;
}

/** All of the data with a little room around; 0 to 1 where there are none. */
export function viewOf(series: readonly PlotSeries[]): View {
  const x = spanOf(series.map((s) => s.x));
  const y = spanOf(series.flatMap((s) => (s.u.length > 0 ? [s.y, s.y.map((v, i) => sum(v, s.u[i], 1)), s.y.map((v, i) => sum(v, s.u[i], -1))] : [s.y])));
  return { x: padded(x, 0.015), y: padded(y, 0.06) };
}

function sum(value: number | null, u: number | null | undefined, sign: 1 | -1): number | null {
  return value === null || typeof u !== 'number' ? value : value + sign * u;
}

function spanOf(columns: Column[]): Range {
  let min = Infinity;
  let max = -Infinity;
  for (const column of columns) {
    for (const value of column) {
      if (value === null || !Number.isFinite(value)) continue;
      if (value < min) min = value;
      if (value > max) max = value;
    }
  }
  return min <= max ? { min, max } : { min: 0, max: 1 };
}

function padded({ min, max }: Range, share: number): Range {
  const span = max - min;
  // A single value, or all the same: some room, so that there is something to look at.
  const room = span > 0 ? span * share : Math.abs(max) * 0.1 || 1;
  return { min: min - room, max: max + room };
}

/** The wider of the two axes is widened further until a metre is as long to the right as upwards. */
export function equalised(view: View, frame: Frame): View {
  const perPixel = Math.max(width(view.x) / frame.width, width(view.y) / frame.height);
  return { x: around(view.x, perPixel * frame.width), y: around(view.y, perPixel * frame.height) };
}

function width(range: Range): number {
  return range.max - range.min;
}

function around(range: Range, span: number): Range {
  const middle = (range.min + range.max) / 2;
  return { min: middle - span / 2, max: middle + span / 2 };
}

export function scaleOf(view: View, frame: Frame): Scale {
  const perX = frame.width / width(view.x);
  const perY = frame.height / width(view.y);
  return {
    toX: (value) => frame.left + (value - view.x.min) * perX,
    toY: (value) => frame.top + frame.height - (value - view.y.min) * perY,
    fromX: (pixel) => view.x.min + (pixel - frame.left) / perX,
    fromY: (pixel) => view.y.min + (frame.top + frame.height - pixel) / perY,
  };
}

/** How far a pointer has to be drawn for a zoom, px; less is a click. */
const least = 8;

/** What was drawn from one corner to another becomes all that is seen. A flat rectangle zooms in x only, an upright one in y
 * only; null if it is too small to be meant. */
export function zoomed(view: View, frame: Frame, from: [number, number], to: [number, number]): View | null {
  const scale = scaleOf(view, frame);
  const wide = Math.abs(to[0] - from[0]) >= least;
  const high = Math.abs(to[1] - from[1]) >= least;
  if (!wide && !high) return null;
  const next: View = {
    x: wide ? sorted(scale.fromX(from[0]), scale.fromX(to[0]), view.x) : view.x,
    y: high ? sorted(scale.fromY(from[1]), scale.fromY(to[1]), view.y) : view.y,
  };
  // Beyond this a double no longer tells the pixels apart.
  const fine = (r: Range) => width(r) > 1e-9 * Math.max(Math.abs(r.min), Math.abs(r.max), 1e-300);
  return fine(next.x) && fine(next.y) ? next : null;
}

function sorted(a: number, b: number, within: Range): Range {
  return { min: Math.max(within.min, Math.min(a, b)), max: Math.min(within.max, Math.max(a, b)) };
}

/** Nearer by a factor (below 1) or further away, around its middle. */
export function magnified(view: View, factor: number, whole: View): View {
  const grow = (range: Range, most: Range) => {
    const next = around(range, width(range) * factor);
    return { min: Math.max(next.min, most.min), max: Math.min(next.max, most.max) };
  };
  return { x: grow(view.x, whole.x), y: grow(view.y, whole.y) };
}

/** Moved by a share of what is seen, no further than the whole. */
export function shifted(view: View, byX: number, byY: number, whole: View): View {
  const move = (range: Range, share: number, most: Range) => {
    const step = Math.max(most.min - range.min, Math.min(most.max - range.max, share * width(range)));
    return { min: range.min + step, max: range.max + step };
  };
  return { x: move(view.x, byX, whole.x), y: move(view.y, byY, whole.y) };
}

/** Round numbers inside a range, about `count` of them. */
export function ticks({ min, max }: Range, count: number): number[] {
  const span = max - min;
  if (!(span > 0) || count < 1) return [];
  const raw = span / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = power * ([1, 2, 5, 10].find((m) => m * power >= raw * 0.999) ?? 10);
  const found: number[] = [];
  for (let i = Math.ceil(min / step - 1e-9); i * step <= max + step * 1e-9; i++) found.push(i * step || 0);
  return found;
}

/** As many decimals as tell neighbours apart; large and tiny ones with a power of ten. */
export function tickText(value: number, all: readonly number[], locale?: string): string {
  const step = all.length > 1 ? Math.abs((all[1] ?? 0) - (all[0] ?? 0)) : Math.abs(value) || 1;
  const largest = Math.max(...all.map(Math.abs), Math.abs(value));
  if (largest >= 1e6 || (largest > 0 && largest < 1e-4)) {
    if (value === 0) return '0';
    const exponent = Math.floor(Math.log10(largest) + 1e-9);
    const decimals = Math.max(0, exponent - Math.floor(Math.log10(step) + 1e-9));
    return `${plain(value / 10 ** exponent, decimals, locale)}·10${superscript(exponent)}`;
  }
  return plain(value, Math.min(12, Math.max(0, -Math.floor(Math.log10(step) + 1e-9))), locale);
}

function plain(value: number, decimals: number, locale?: string): string {
  return new Intl.NumberFormat(locale, { minimumFractionDigits: decimals, maximumFractionDigits: decimals, useGrouping: false })
    .format(value).replace('-', '\u2212');
}

function superscript(exponent: number): string {
  return String(exponent).replace('-', '⁻').replace(/\d/g, (digit) => '⁰¹²³⁴⁵⁶⁷⁸⁹'.charAt(Number(digit)));
}

/** The runs of neighbours that are there, as [from, to): a gap breaks a line. */
export function pieces(x: Column, y: Column): [number, number][] {
  const found: [number, number][] = [];
  let begin = -1;
  for (let i = 0; i <= x.length; i++) {
    const there = i < x.length && typeof x[i] === 'number' && typeof y[i] === 'number';
    if (there && begin < 0) begin = i;
    if (!there && begin >= 0) {
      found.push([begin, i]);
      begin = -1;
    }
  }
  return found;
}

export interface Nearest {
  series: number;
  index: number;
  x: number;
  y: number;
  u: number | null;
}

/** The value nearest to a pixel, no further than `reach` pixels; null if there is none. */
export function nearest(series: readonly PlotSeries[], scale: Scale, px: number, py: number, reach: number): Nearest | null {
  let best = reach * reach;
  let found: Nearest | null = null;
  series.forEach((s, number) => {
    for (let i = 0; i < s.x.length; i++) {
      const x = s.x[i];
      const y = s.y[i];
      if (typeof x !== 'number' || typeof y !== 'number') continue;
      const distance = (scale.toX(x) - px) ** 2 + (scale.toY(y) - py) ** 2;
      if (distance >= best) continue;
      best = distance;
      found = { series: number, index: i, x, y, u: s.u[i] ?? null };
    }
  });
  return found;
}

/** `residual / mm` → what it is and its unit. */
export function axisParts(label: string): { name: string; unit: string } {
  const at = label.lastIndexOf(' / ');
  return at < 0 ? { name: label, unit: '' } : { name: label.slice(0, at), unit: label.slice(at + 3).replace(/^\((.*)\)$/, '$1') };
}
