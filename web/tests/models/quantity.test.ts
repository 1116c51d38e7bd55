import { expect, it } from 'vitest';
import { facts } from '../../src/models/provenance';
import { inReadingOrder } from '../../src/models/words';
import { budgetBars, forPeople } from '../../src/models/quantity';

it('turns angles into degrees, uncertainty and budget with them', () => {
  const m = forPeople({ name: 'amplitude', value: Math.PI / 18, u: Math.PI / 1800, unit: 'rad', budget: [{ source: 'a', u: Math.PI / 180 }] });
  expect(m.unit).toBe('°');
  expect(m.value).toBeCloseTo(10);
  expect(m.u).toBeCloseTo(0.1);
  expect(m.budget?.[0]?.u).toBeCloseTo(1);
});

it('shows the largest source first, with its share of the variance', () => {
  const bars = budgetBars([{ source: 'clock', u: 3 }, { source: 'length', u: 4 }]);
  expect(bars.map((b) => [b.source, b.share, b.length])).toEqual([['length', 0.64, 1], ['clock', 0.36, 0.75]]);
  expect(budgetBars([{ source: 'none', u: 0 }])[0]).toMatchObject({ share: 0, length: 0 });
});

it('tells the turning of the Earth by the hour, of a robot by the second', () => {
  expect(forPeople({ name: 'turning_rate', value: 5.1e-5, u: 1e-6, unit: 'rad/s' })).toMatchObject({ unit: '°/h' });
  expect(forPeople({ name: 'turning_rate', value: 0.5, u: 1e-3, unit: 'rad/s' })).toMatchObject({ unit: '°/s' });
});

it('lists settings as the definition has them, what it does not know last', () => {
  const definition = [{ name: 'length_m' }, { name: 'amplitude_deg' }, { name: 'duration_s' }];
  expect(inReadingOrder({ zeta: 1, alpha: 2, duration_s: 30, amplitude_deg: 10, length_m: 1 }, definition).map(([name]) => name)).toEqual([
    'length_m', 'amplitude_deg', 'duration_s', 'alpha', 'zeta',
  ]);
});

it('lays nested provenance out flat', () => {
  expect(facts({ program: 'kinectlab 0.1', device: { uri: 'sim://1', none: null }, seeds: [1, 2] })).toEqual([
    { label: 'Program', value: 'kinectlab 0.1', first: true },
    { label: 'Device, uri', value: 'sim://1', first: false },
    { label: 'Seeds', value: '1, 2', first: false },
  ]);
});
