/** The page's colours for what is drawn on a canvas. */
export function color(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

export const plotFont = '12px system-ui, "Noto Sans", "DejaVu Sans", sans-serif';

/** Calls back when the viewer's system turns light or dark; returns how to end it. */
export function onThemeChange(callback: () => void): () => void {
  const dark = matchMedia('(prefers-color-scheme: dark)');
  dark.addEventListener('change', callback);
  return () => dark.removeEventListener('change', callback);
}

const objectColors = ['--object-1', '--object-2', '--object-3', '--object-4'];

/** The colour of the n-th thing that is watched, the same in every view. */
export function objectColor(place: number): string {
  return objectColors[Math.max(0, place) % objectColors.length] ?? '--object-1';
}
