/** Calls back at every animation frame until the returned function is called. Browsers pause it while
 * the page is not looked at. */
export function onFrame(callback: () => void): () => void {
  let handle = requestAnimationFrame(function step() {
    callback();
    handle = requestAnimationFrame(step);
  });
  return () => cancelAnimationFrame(handle);
}

/** The half-width of a symmetric axis that holds `value`: it grows in steps and never jitters. */
export function growReach(reach: number, value: number, step = 0.05): number {
  if (!Number.isFinite(value) || Math.abs(value) <= reach) return reach;
  return Math.ceil(Math.abs(value) / step + 0.2) * step;
}
