/** How long to wait before the n-th new attempt (0, 1, …), ms: doubling to 8 s, with a random third so
 * that a whole class does not come back in the same instant. */
export function backoffDelay(attempt: number, random: () => number = Math.random): number {
  const full = Math.min(8000, 500 * 2 ** Math.min(attempt, 10));
  return Math.round(full * (2 / 3 + random() / 3));
}
