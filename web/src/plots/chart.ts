/** Draws a plot of a run on a canvas: axes, lines, points, error bars, what is pointed at. */
import type { Plot, PlotSeries } from '../api/analysis';
import { pieces, scaleOf, ticks, tickText, type Frame, type Nearest, type Scale, type View } from '../models/plot_scale';
import { color, plotFont } from './theme';

const pointColors = ['--plot-x', '--plot-z', '--plot-5', '--plot-4'];
const lineColors = ['--plot-y', '--plot-4', '--plot-5', '--plot-z'];

/** Where there are points the lines are what was fitted to them; lines alone take the colours of what was measured. */
export function colorNameOf(plot: Plot, series: number): string {
  const mark = plot.series[series]?.mark;
  const place = plot.series.slice(0, series).filter((s) => s.mark === mark).length;
  const colors = mark === 'line' && plot.series.some((s) => s.mark === 'points') ? lineColors : pointColors;
  return colors[place % colors.length] ?? '--plot-x';
}

/** Room for the labels of both axes. */
export function frameOf(g: CanvasRenderingContext2D, view: View, width: number, height: number): Frame {
  g.font = plotFont;
  const marks = ticks(view.y, height / 50);
  const widest = Math.max(20, ...marks.map((v) => g.measureText(tickText(v, marks)).width));
  const left = Math.ceil(widest) + 32;
  return { left, top: 10, width: Math.max(40, width - left - 12), height: Math.max(40, height - 10 - 44) };
}

export interface ChartPicture {
  plot: Plot;
  view: View;
  frame: Frame;
  hidden: ReadonlySet<number>;
  pointed: Nearest | null;
  selection: [number, number, number, number] | null;
}

export function drawChart(g: CanvasRenderingContext2D, picture: ChartPicture): void {
  const { plot, view, frame, hidden, pointed, selection } = picture;
  const scale = scaleOf(view, frame);
  drawAxes(g, plot, view, frame, scale);
  g.save();
  g.beginPath();
  g.rect(frame.left, frame.top, frame.width, frame.height);
  g.clip();
  // Points first: a fit that hides behind what it fits could not be judged.
  for (const mark of ['points', 'line'] as const) {
    plot.series.forEach((series, i) => {
      if (series.mark !== mark || hidden.has(i)) return;
      const shade = color(colorNameOf(plot, i));
      if (mark === 'line') drawLine(g, series, scale, shade);
      else drawPoints(g, series, scale, shade);
    });
  }
  if (pointed) drawPointed(g, scale, pointed, color(colorNameOf(plot, pointed.series)));
  if (selection) drawSelection(g, frame, selection);
  g.restore();
}

function drawAxes(g: CanvasRenderingContext2D, plot: Plot, view: View, frame: Frame, scale: Scale): void {
  const { left, top, width, height } = frame;
  g.font = plotFont;
  g.lineWidth = 1;
  const soft = color('--text-soft');
  const columns = ticks(view.x, width / 80);
  const rows = ticks(view.y, height / 50);
  g.strokeStyle = color('--plot-grid');
  g.beginPath();
  for (const v of columns) {
    const x = Math.round(scale.toX(v)) + 0.5;
    g.moveTo(x, top);
    g.lineTo(x, top + height);
  }
  for (const v of rows) {
    const y = Math.round(scale.toY(v)) + 0.5;
    g.moveTo(left, y);
    g.lineTo(left + width, y);
  }
  g.stroke();
  g.strokeStyle = color('--line-strong');
  g.strokeRect(left + 0.5, top + 0.5, width, height);
  g.fillStyle = soft;
  g.textBaseline = 'top';
  g.textAlign = 'center';
  for (const v of columns) g.fillText(tickText(v, columns), scale.toX(v), top + height + 6);
  g.fillText(plot.xLabel, left + width / 2, top + height + 25);
  g.textBaseline = 'middle';
  g.textAlign = 'right';
  for (const v of rows) g.fillText(tickText(v, rows), left - 7, scale.toY(v));
  g.save();
  g.translate(10, top + height / 2);
  g.rotate(-Math.PI / 2);
  g.textAlign = 'center';
  g.fillText(plot.yLabel, 0, 0);
  g.restore();
}

function drawLine(g: CanvasRenderingContext2D, series: PlotSeries, scale: Scale, shade: string): void {
  g.strokeStyle = shade;
  g.lineWidth = 1.6;
  g.lineJoin = 'round';
  g.beginPath();
  for (const [from, to] of pieces(series.x, series.y)) {
    for (let i = from; i < to; i++) {
      const x = scale.toX(series.x[i] ?? NaN);
      const y = scale.toY(series.y[i] ?? NaN);
      if (i === from) g.moveTo(x, y);
      else g.lineTo(x, y);
    }
  }
  g.stroke();
}

function drawPoints(g: CanvasRenderingContext2D, series: PlotSeries, scale: Scale, shade: string): void {
  const radius = series.x.length > 1500 ? 1.4 : series.x.length > 200 ? 2 : 3;
  if (series.u.length > 0) drawErrorBars(g, series, scale, shade);
  g.fillStyle = shade;
  g.beginPath();
  series.x.forEach((x, i) => {
    const y = series.y[i];
    if (x === null || typeof y !== 'number') return;
    const px = scale.toX(x);
    const py = scale.toY(y);
    g.moveTo(px + radius, py);
    g.arc(px, py, radius, 0, 2 * Math.PI);
  });
  g.fill();
}

function drawErrorBars(g: CanvasRenderingContext2D, series: PlotSeries, scale: Scale, shade: string): void {
  const cap = series.x.length > 200 ? 0 : 3;
  g.strokeStyle = shade;
  g.lineWidth = 1;
  g.globalAlpha = cap > 0 ? 0.8 : 0.35;
  g.beginPath();
  series.x.forEach((x, i) => {
    const y = series.y[i];
    const u = series.u[i];
    if (x === null || typeof y !== 'number' || typeof u !== 'number') return;
    const px = scale.toX(x);
    const ends = [scale.toY(y - u), scale.toY(y + u)] as const;
    g.moveTo(px, ends[0]);
    g.lineTo(px, ends[1]);
    if (cap === 0) return;
    for (const end of ends) {
      g.moveTo(px - cap, end);
      g.lineTo(px + cap, end);
    }
  });
  g.stroke();
  g.globalAlpha = 1;
}

function drawPointed(g: CanvasRenderingContext2D, scale: Scale, pointed: Nearest, shade: string): void {
  g.strokeStyle = shade;
  g.fillStyle = color('--surface');
  g.lineWidth = 2.5;
  g.beginPath();
  g.arc(scale.toX(pointed.x), scale.toY(pointed.y), 5, 0, 2 * Math.PI);
  g.fill();
  g.stroke();
}

function drawSelection(g: CanvasRenderingContext2D, frame: Frame, [x0, y0, x1, y1]: [number, number, number, number]): void {
  const wide = Math.abs(x1 - x0) >= 8;
  const high = Math.abs(y1 - y0) >= 8;
  if (!wide && !high) return;
  const left = wide ? Math.min(x0, x1) : frame.left;
  const right = wide ? Math.max(x0, x1) : frame.left + frame.width;
  const top = high ? Math.min(y0, y1) : frame.top;
  const bottom = high ? Math.max(y0, y1) : frame.top + frame.height;
  g.fillStyle = color('--accent');
  g.globalAlpha = 0.15;
  g.fillRect(left, top, right - left, bottom - top);
  g.globalAlpha = 1;
  g.strokeStyle = color('--accent');
  g.lineWidth = 1;
  g.strokeRect(left + 0.5, top + 0.5, right - left, bottom - top);
}
