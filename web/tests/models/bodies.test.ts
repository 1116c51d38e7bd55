import { expect, it } from 'vitest';
import { lookOf } from '../../src/models/apparatus';
import { bodiesOf } from '../../src/models/bodies';
import { grown, grownBox } from '../../src/models/reach';
import { strobe } from '../../src/models/strobe';

it('draws what the definition follows', () => {
  const objects = [
    { name: 'bob', method: 'sphere', settings: { radius_m: { parameter: 'bob_radius_m' } } },
    { name: 'puck', method: 'sphere', settings: { radius_m: 0.02 } },
    { name: 'box', method: 'texture', settings: {} },
    { name: 'can', method: 'cylinder', settings: { radius_m: { parameter: 'unknown' } } },
  ];
  expect(bodiesOf(objects, { bob_radius_m: 0.03 })).toEqual([
    { name: 'bob', shape: 'sphere', radius: 0.03 },
    { name: 'puck', shape: 'sphere', radius: 0.02 },
    { name: 'box', shape: 'box', size: [0.1, 0.1, 0.1] },
    { name: 'can', shape: 'cylinder', radius: 0.05, length: 0.2 },
  ]);
});

it('grows in steps and stays where it is enough', () => {
  const first = grown(null, 0.42, 0.1);
  expect(first?.min).toBeLessThan(0.42);
  expect(first?.max).toBeGreaterThan(0.42);
  expect(grown(first, 0.43, 0.1)).toBe(first);
  expect(grown(first, NaN, 0.1)).toBe(first);
  const box = grownBox(null, [0, 0, 1], 0.05);
  expect(grownBox(box, [0.01, 0, 1], 0.05)).toBe(box);
  expect(grownBox(box, [NaN, 0, 1], 0.05)).toBe(box);
  expect(grownBox(box, [3, 0, 1], 0.05)?.[0].max).toBeGreaterThan(3);
});

it('shows an apparatus that nobody drew', () => {
  const strange = { id: 'x', apparatus: 'catapult', analysis: { method: 'thrown', objects: [] } };
  expect(strobe(strange).length).toBeGreaterThan(0);
  expect(lookOf(strange).directions).toEqual(['x', 'y', 'z']);
  expect(lookOf({ ...strange, analysis: { method: 'spring', objects: [] } }).directions).toEqual(['z']);
});
