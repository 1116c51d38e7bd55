import { expect, it } from 'vitest';
import { boxFraming, pendulumFraming, pivotHeight, viewpoint } from '../../src/scene/geometry';

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

it('frames whatever moves, and the floor lies under it', () => {
  const framing = boxFraming([{ min: 0, max: 2 }, { min: -0.1, max: 0.1 }, { min: 0.5, max: 1.5 }]);
  expect(framing.target).toEqual([1, 0, 1]);
  expect(framing.floor).toBeLessThan(0.5);
  expect(framing.distance).toBeGreaterThan(2);
  expect(boxFraming(null).distance).toBeGreaterThan(1);
  expect(pendulumFraming(1, 0.05, 2).floor).toBeCloseTo(0.83);
});
