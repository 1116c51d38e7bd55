import { equalised, ticks, tickText, scaleOf, type View } from '../models/plot_scale';
import { prepare } from './canvas';
import { color, plotFont } from './theme';

export interface PathTrack {
  right: Float64Array;
  up: Float64Array;
  /** Name of the colour of what moves along it. */
  colorName: string;
}

/** Draws paths seen along one axis, both directions to the same scale. Older points are fainter. */
export function drawPaths(canvas: HTMLCanvasElement, tracks: readonly PathTrack[], view: View, names: readonly [string, string]): void {
  const paper = prepare(canvas);
  if (!paper) return;
  const { g, width, height } = paper;
  const frame = { left: 56, top: 8, width: width - 64, height: height - 46 };
  const seen = equalised(view, frame);
  const scale = scaleOf(seen, frame);

  g.font = plotFont;
  g.lineWidth = 1;
  g.strokeStyle = color('--plot-grid');
  g.fillStyle = color('--text-soft');
  const columns = ticks(seen.x, frame.width / 70);
  const rows = ticks(seen.y, frame.height / 45);
  g.beginPath();
  for (const v of columns) {
    g.moveTo(scale.toX(v), frame.top);
    g.lineTo(scale.toX(v), frame.top + frame.height);
  }
  for (const v of rows) {
    g.moveTo(frame.left, scale.toY(v));
    g.lineTo(frame.left + frame.width, scale.toY(v));
  }
  g.stroke();
  g.textAlign = 'center';
  g.textBaseline = 'top';
  for (const v of columns) g.fillText(tickText(v, columns), scale.toX(v), frame.top + frame.height + 5);
  g.fillText(`${names[0]} in m`, frame.left + frame.width / 2, height - 15);
  g.textAlign = 'right';
  g.textBaseline = 'middle';
  for (const v of rows) g.fillText(tickText(v, rows), frame.left - 6, scale.toY(v));
  g.save();
  g.translate(7, frame.top + frame.height / 2);
  g.rotate(-Math.PI / 2);
  g.textAlign = 'center';
  g.fillText(`${names[1]} in m`, 0, 0);
  g.restore();

  for (const track of tracks) drawTrack(g, track, scale.toX, scale.toY);
}

function drawTrack(g: CanvasRenderingContext2D, { right, up, colorName }: PathTrack, toX: (v: number) => number, toY: (v: number) => number): void {
  const n = right.length;
  g.fillStyle = color(colorName);
  for (let i = 0; i < n; i++) {
    g.globalAlpha = 0.08 + 0.6 * (i / n) ** 2;
    g.fillRect(toX(right[i] ?? NaN) - 1, toY(up[i] ?? NaN) - 1, 2.4, 2.4);
  }
  g.globalAlpha = 1;
  if (n === 0) return;
  g.beginPath();
  g.arc(toX(right[n - 1] ?? NaN), toY(up[n - 1] ?? NaN), 6, 0, 2 * Math.PI);
  g.fill();
}
