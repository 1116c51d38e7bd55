import { describe, expect, it } from 'vitest';
import type { PlotSeries } from '../../src/api/analysis';
import { readPlots } from '../../src/api/analysis';
import { axisParts, equalised, magnified, nearest, pieces, scaleOf, shifted, ticks, tickText, viewOf, zoomed } from '../../src/models/plot_scale';

const frame = { left: 50, top: 10, width: 400, height: 200 };
const view = { x: { min: 0, max: 10 }, y: { min: -1, max: 1 } };
const series = (x: (number | null)[], y: (number | null)[], u: (number | null)[] = []): PlotSeries => ({ name: 's', mark: 'points', x, y, u });

describe('plots from the server', () => {
  it('keep their gaps and lose what has no partner', () => {
    const [plot] = readPlots({
      plots: [{ name: 'p', title: 'P', x_label: 't / s', y_label: 'x / m', equal_axes: true, series: [{ name: 'a', mark: 'points', x: [0, 1, 2, 3], y: [1, null, 'x'], u: [0.1] }] }],
    });
    expect(plot).toEqual({
      name: 'p', title: 'P', xLabel: 't / s', yLabel: 'x / m', equalAxes: true,
      series: [{ name: 'a', mark: 'points', x: [0, 1, 2], y: [1, null, null], u: [0.1] }],
    });
  });

  it.each([null, {}, { plots: 'none' }, { plots: [null] }])('that are none do no harm: %j', (json) => {
    expect(readPlots(json).every((p) => p.series.length === 0)).toBe(true);
  });
});

describe('what is seen', () => {
  it('holds all values and their uncertainties', () => {
    const { x, y } = viewOf([series([0, 10, null, NaN], [1, 2, 900, 800], [0.5, 3, 0, 0])]);
    expect([x.min < 0, x.max > 10, x.max < 11]).toEqual([true, true, true]);
    expect([y.min < -1, y.max > 5]).toEqual([true, true]);
  });

  it('has room around a single value, and around none', () => {
    expect(viewOf([series([2], [0])]).x).toEqual({ min: 1.8, max: 2.2 });
    expect(viewOf([series([], [])]).y.max).toBeGreaterThan(viewOf([]).y.min);
  });

  it('has a metre of one length in both directions where asked', () => {
    const seen = equalised(view, frame);
    const scale = scaleOf(seen, frame);
    expect(scale.toX(1) - scale.toX(0)).toBeCloseTo(scale.toY(0) - scale.toY(1));
    expect(seen.x).toEqual(view.x);
    expect(seen.y.max - seen.y.min).toBeCloseTo(5);
  });
});

describe('zoom', () => {
  it('takes what was drawn, from any corner', () => {
    const wanted = { x: { min: 2.5, max: 5 }, y: { min: -0.5, max: 0.5 } };
    expect(zoomed(view, frame, [150, 60], [250, 160])).toEqual(wanted);
    expect(zoomed(view, frame, [250, 160], [150, 60])).toEqual(wanted);
  });

  it('keeps the other axis where only one was meant, and stays inside', () => {
    expect(zoomed(view, frame, [150, 60], [900, 63])).toEqual({ x: { min: 2.5, max: 10 }, y: view.y });
    expect(zoomed(view, frame, [150, 60], [153, 160])).toEqual({ x: view.x, y: { min: -0.5, max: 0.5 } });
  });

  it('is none for a click, nor beyond what numbers can tell', () => {
    expect(zoomed(view, frame, [150, 60], [154, 62])).toBeNull();
    const tiny = { x: { min: 1, max: 1 + 1e-9 }, y: view.y };
    expect(zoomed(tiny, frame, [150, 60], [160, 60])).toBeNull();
  });

  it('by keys never leaves the whole', () => {
    const near = magnified(view, 0.5, view);
    expect(near.x).toEqual({ min: 2.5, max: 7.5 });
    expect(magnified(near, 10, view)).toEqual(view);
    expect(shifted(near, 1, 0, view).x).toEqual({ min: 5, max: 10 });
    expect(shifted(near, -9, 0, view).x).toEqual({ min: 0, max: 5 });
  });
});

describe('ticks', () => {
  it('are round and inside', () => {
    expect(ticks({ min: -0.31, max: 0.32 }, 6)).toEqual([-0.2, 0, 0.2]);
    expect(ticks({ min: 0, max: 30 }, 6)).toEqual([0, 5, 10, 15, 20, 25, 30]);
    expect(ticks({ min: 1, max: 1 }, 5)).toEqual([]);
  });

  it('show as many digits as tell them apart', () => {
    const text = (values: number[]) => values.map((v) => tickText(v, values, 'en'));
    expect(text([-0.2, 0, 0.2])).toEqual(['\u22120.2', '0.0', '0.2']);
    expect(text([5, 10])).toEqual(['5', '10']);
    expect(text([0, 2e-6, 4e-6])).toEqual(['0', '2·10⁻⁶', '4·10⁻⁶']);
    expect(text([1.5e7, 2e7])).toEqual(['1.5·10⁷', '2.0·10⁷']);
  });
});

it('breaks a line at gaps', () => {
  expect(pieces([0, 1, 2, 3, 4], [1, 1, null, 1, 1])).toEqual([[0, 2], [3, 5]]);
  expect(pieces([null], [1])).toEqual([]);
});

it('finds what is under the pointer, within reach', () => {
  const scale = scaleOf(view, frame);
  const all = [series([0, 5, null], [0, 0.5, 0], [0, 0.1]), series([5], [0.6])];
  expect(nearest(all, scale, scale.toX(5), scale.toY(0.5) + 2, 20)).toMatchObject({ series: 0, index: 1, x: 5, y: 0.5, u: 0.1 });
  expect(nearest(all, scale, scale.toX(5), scale.toY(0.6), 20)).toMatchObject({ series: 1, u: null });
  expect(nearest(all, scale, scale.toX(8), scale.toY(0), 20)).toBeNull();
});

it('tells a label from its unit', () => {
  expect(axisParts('residual / mm')).toEqual({ name: 'residual', unit: 'mm' });
  expect(axisParts('v / (m/s)')).toEqual({ name: 'v', unit: 'm/s' });
  expect(axisParts('n')).toEqual({ name: 'n', unit: '' });
});
