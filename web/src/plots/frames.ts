const drawings = new Set<() => void>();
const afterPaint = new MessageChannel();
let handle = 0;
let started = 0;
let restUntil = 0;

// Where drawing is slow (no graphics card) the page rests as long as it drew, so that what arrives and
// what a person presses always get their turn.
afterPaint.port1.onmessage = () => {
  const now = performance.now();
  restUntil = now + Math.min(500, now - started);
};

function step(): void {
  handle = requestAnimationFrame(step);
  started = performance.now();
  if (started < restUntil) return;
  for (const draw of drawings) draw();
  afterPaint.port2.postMessage(null);
}

/** Calls back at every animation frame, or less often on a slow machine, until the returned function is
 * called. Browsers pause it while the page is not looked at. */
export function onFrame(draw: () => void): () => void {
  drawings.add(draw);
  if (drawings.size === 1) handle = requestAnimationFrame(step);
  return () => {
    drawings.delete(draw);
    if (drawings.size === 0) cancelAnimationFrame(handle);
  };
}
