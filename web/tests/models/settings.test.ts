import { expect, it } from 'vitest';
import { readMethods, readVersions } from '../../src/api/analysis';
import { readSettings, settingTexts, withoutIt } from '../../src/models/settings';

const [method] = readMethods({
  analyses: [{
    name: 'pendulum', objects: 1,
    settings: [
      { name: 'length_m', min: 0.05, max: 100, otherwise: null, required: false, help: 'Left away: estimated.' },
      { name: 'length_u_m', min: 0, max: 10, otherwise: 0.0005, required: false, help: '' },
      { name: 'mass_kg', min: 0, max: 10, otherwise: null, required: true, help: '' },
    ],
  }],
});
const settings = method?.settings ?? [];

it('takes a setting away that is emptied', () => {
  const texts = settingTexts(settings, { length_m: 1.2, mass_kg: 0.5 });
  expect(texts).toEqual({ length_m: '1.2', length_u_m: '', mass_kg: '0.5' });
  expect(readSettings(settings, { ...texts, length_m: ' ' })).toEqual({ values: { length_m: null, length_u_m: null, mass_kg: 0.5 }, errors: [] });
});

it('refuses what cannot be', () => {
  const { errors } = readSettings(settings, { length_m: '0.001', length_u_m: 'well', mass_kg: '' });
  expect(errors.map((e) => e.field)).toEqual(['settings.length_m', 'settings.length_u_m', 'settings.mass_kg']);
});

it('says what holds instead', () => {
  expect(settings.map((s) => withoutIt(s).replaceAll('\u202f', ' '))).toEqual(['may be left empty', '0.0005 m if empty', 'needed']);
});

it('puts versions in order and leaves out what is none', () => {
  const result = { experiment: 'x', parameters: {}, results: [], provenance: {} };
  const read = readVersions({ results: [{ version: 2, created: 'b', person: 'Ada', result }, { version: 1, created: 'a', person: null, result }, { version: 3 }] });
  expect(read.map((v) => [v.version, v.person])).toEqual([[1, null], [2, 'Ada']]);
});
