import { expect, it } from 'vitest';
import { SlidingColumns } from '../../src/models/ring';

it('keeps the newest rows in one piece, in order, over many turns', () => {
  const ring = new SlidingColumns(2, 5);
  for (let i = 0; i < 23; i++) {
    ring.push(i, -i);
    const from = Math.max(0, i - 4);
    expect([...ring.column(0)]).toEqual(Array.from({ length: i - from + 1 }, (_, k) => from + k));
  }
  expect([...ring.column(1)]).toEqual([-18, -19, -20, -21, -22]);
  expect(ring.last(0)).toBe(22);
});

it('finds the first row from a time on', () => {
  const ring = new SlidingColumns(1, 4);
  for (const t of [1, 2, 3, 5, 8, 13]) ring.push(t);
  expect([...ring.column(0, ring.lowerBound(0, 4))]).toEqual([5, 8, 13]);
  expect(ring.lowerBound(0, 99)).toBe(4);
});

it('is empty again after clear, and a missing value is NaN', () => {
  const ring = new SlidingColumns(2, 3);
  ring.push(1);
  expect(ring.last(1)).toBeNaN();
  ring.clear();
  expect(ring.length).toBe(0);
  expect(ring.last(0)).toBeNaN();
});
