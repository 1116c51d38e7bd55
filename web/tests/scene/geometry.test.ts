import { expect, it } from 'vitest';
import { pivotHeight, viewpoint } from '../../src/scene/geometry';

it('finds the pivot above the bob wherever the bob is on its way', () => {
  for (const angle of [0, 0.2, -0.5]) {
    expect(pivotHeight([1.2 * Math.sin(angle), 0, 2 - 1.2 * Math.cos(angle)], 1.2)).toBeCloseTo(2);
  }
  expect(pivotHeight([2, 0, 0], 1)).toBeNaN();
  expect(pivotHeight([NaN, NaN, NaN], 1)).toBeNaN();
});

it('stands before, beside and above the rig', () => {
  const round = (v: number[]) => v.map((x) => Math.round(x * 1e6) / 1e6 + 0);
  expect(round(viewpoint([0, 0, 1], 0, 0, 3))).toEqual([0, -3, 1]);
  expect(round(viewpoint([0, 0, 1], Math.PI / 2, 0, 3))).toEqual([3, 0, 1]);
  expect(round(viewpoint([0, 0, 1], 0, Math.PI / 2, 3))).toEqual([0, 0, 4]);
});
