import { color, plotFont } from './theme';

export interface PathData {
  x: Float64Array;
  y: Float64Array;
  reach: number;
}

/** Draws a path seen from above, both axes to the same scale. Older points are fainter. */
export function drawPath(canvas: HTMLCanvasElement, { x, y, reach }: PathData): void {
  const ratio = Math.min(devicePixelRatio, 2);
  const width = canvas.clientWidth;
  const height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const g = canvas.getContext('2d');
  if (!g) return;
  g.setTransform(ratio, 0, 0, ratio, 0, 0);
  g.clearRect(0, 0, width, height);

  const scale = (Math.min(width, height) / 2 - 18) / reach;
  const toX = (v: number) => width / 2 + v * scale;
  const toY = (v: number) => height / 2 - v * scale;

  g.strokeStyle = color('--plot-grid');
  g.lineWidth = 1;
  for (const share of [0.5, 1]) {
    g.beginPath();
    g.arc(toX(0), toY(0), reach * share * scale, 0, 2 * Math.PI);
    g.stroke();
  }
  g.beginPath();
  g.moveTo(toX(-reach), toY(0));
  g.lineTo(toX(reach), toY(0));
  g.moveTo(toX(0), toY(-reach));
  g.lineTo(toX(0), toY(reach));
  g.stroke();
  g.fillStyle = color('--text-soft');
  g.font = plotFont;
  g.textBaseline = 'bottom';
  g.fillText('x', toX(reach) + 5, toY(0) + 6);
  g.fillText('y', toX(0) + 5, toY(reach) + 2);
  g.fillText(`${(reach * 100).toFixed(0)} cm`, toX(0) + 6, toY(-reach) - 3);

  const n = x.length;
  g.fillStyle = color('--plot-x');
  for (let i = 0; i < n; i++) {
    g.globalAlpha = 0.08 + 0.6 * (i / n) ** 2;
    g.fillRect(toX(x[i] ?? NaN) - 1, toY(y[i] ?? NaN) - 1, 2.4, 2.4);
  }
  g.globalAlpha = 1;
  if (n === 0) return;
  g.fillStyle = color('--bob');
  g.beginPath();
  g.arc(toX(x[n - 1] ?? NaN), toY(y[n - 1] ?? NaN), 7, 0, 2 * Math.PI);
  g.fill();
}
