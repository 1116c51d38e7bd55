/** uPlot with the look of the pages. This file is loaded only where something is plotted. */
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { color, plotFont } from './theme';

export { uPlot };

export function axis(label: string, options: Partial<uPlot.Axis> = {}): uPlot.Axis {
  return {
    label,
    labelFont: plotFont,
    labelSize: 20,
    labelGap: 0,
    size: 26,
    gap: 4,
    font: plotFont,
    stroke: color('--text-soft'),
    grid: { stroke: color('--plot-grid'), width: 1 },
    ticks: { stroke: color('--plot-grid'), width: 1, size: 4 },
    ...options,
  };
}

/** Measured values: dots, never joined, so that a lost frame is seen as a gap. */
export function dots(label: string, colorName: string, size = 4): uPlot.Series {
  const stroke = color(colorName);
  return { label, stroke, paths: () => null, points: { show: true, size, width: 0, fill: stroke, stroke } };
}

export function line(label: string, colorName: string, width = 1.5): uPlot.Series {
  return { label, stroke: color(colorName), width, points: { show: false } };
}

/** Keeps a plot as wide as its place. */
export function followWidth(plot: uPlot, place: HTMLElement, height: number): () => void {
  const observer = new ResizeObserver(() => {
    const width = Math.floor(place.clientWidth);
    if (width > 0 && width !== plot.width) plot.setSize({ width, height });
  });
  observer.observe(place);
  return () => observer.disconnect();
}
