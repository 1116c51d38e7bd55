import { describe, expect, it } from 'vitest';
import { readDefinition } from '../../src/api/experiment';
import { defaultsOf, groupParameters, measuringTime, offeredOn, rangeText, readParameters } from '../../src/models/parameters';

const definition = readDefinition('pendulum', {
  title: 'Foucault pendulum',
  parameters: [
    { name: 'length_m', unit: 'm', min: 0.3, max: 1.5, step: 0.01, default: 1, help: 'Pivot to bob.', simulation_only: false },
    { name: 'gravity', unit: 'm/s²', min: 1, max: 25, step: 0.01, default: 9.81, help: '', simulation_only: true },
    { name: 'latitude_deg', unit: '°', min: -90, max: 90, step: 0.1, default: 45, help: '', simulation_only: false },
  ],
});

it('reads what was typed', () => {
  expect(readParameters(definition.parameters, { length_m: '1,2', gravity: '1.62', latitude_deg: '-33' })).toEqual({
    values: { length_m: 1.2, gravity: 1.62, latitude_deg: -33 }, errors: [],
  });
});

it('names the field, what is wrong and what would be right', () => {
  const { errors, values } = readParameters(definition.parameters, { length_m: '9', gravity: 'much', latitude_deg: '' });
  expect(errors.map((e) => [e.field, e.message.replaceAll('\u202f', ' ')])).toEqual([
    ['parameters.length_m', 'is 9 m'], ['parameters.gravity', '“much” is not a number'], ['parameters.latitude_deg', 'is empty'],
  ]);
  expect(errors[0]?.cure?.replaceAll('\u202f', ' ')).toBe('give a number from 0.3 to 1.5 m');
  expect(values).toEqual({});
});

it('leaves out what only a simulation can change on a real rig', () => {
  const names = (simulated: boolean) => groupParameters(definition.parameters, simulated).first.map((p) => p.name);
  expect(names(true)).toEqual(['length_m', 'gravity', 'latitude_deg']);
  expect(names(false)).toEqual(['length_m', 'latitude_deg']);
  expect(rangeText(definition.parameters[0]!)).toBe('0.3 to 1.5');
});

it('refuses a definition from which no field can be built', () => {
  expect(() => readDefinition('pendulum', { parameters: [{ unit: 'm' }] })).toThrow('without a name');
  expect(readDefinition('other', null)).toMatchObject({ id: 'other', title: 'other', summary: '', parameters: [], objects: [], mine: false });
});

describe('a parameter without a default', () => {
  const optional = readDefinition('x', {
    parameters: [
      { name: 'string_mass_kg', unit: 'kg', min: 0, max: 1, step: 0.001, default: null, help: '' },
      { name: 'length_u_m', unit: 'm', min: 0, max: 0.1, step: 0.001, default: 0.001, help: '' },
      { name: 'length_m', unit: 'm', min: 0, max: 2, step: 0.01, default: 1, help: '' },
      { name: 'duration_s', unit: 's', min: 10, max: 600, step: 1, default: 90, help: '' },
    ],
  }).parameters;

  it('is left away unless it is filled in', () => {
    const texts = { length_m: '1', length_u_m: '0.001', duration_s: '30' };
    expect(readParameters(optional, texts)).toEqual({ values: { length_m: 1, length_u_m: 0.001, duration_s: 30 }, errors: [] });
    expect(readParameters(optional, { ...texts, string_mass_kg: '0,01' }).values['string_mass_kg']).toBe(0.01);
    expect(readParameters(optional, { ...texts, string_mass_kg: 'light' }).errors).toHaveLength(1);
    expect(defaultsOf(optional)).toEqual({ length_u_m: 0.001, length_m: 1, duration_s: 90 });
  });

  it('stands with the uncertainties among what is for the curious', () => {
    const { first, more } = groupParameters(optional, true);
    expect(first.map((p) => p.name)).toEqual(['length_m', 'duration_s']);
    expect(more.map((p) => p.name)).toEqual(['string_mass_kg', 'length_u_m']);
  });

  it('does not hide how long it takes', () => {
    expect(measuringTime(optional).replaceAll('\u00a0', ' ')).toBe('measures for 2 min');
    expect(measuringTime([])).toBe('');
  });
});

it('knows of a simulated rig what of a real one would be a guess', () => {
  const { parameters } = readDefinition('x', {
    parameters: [{ name: 'bob_density_kg_m3', unit: 'kg/m³', min: 0, max: 23000, step: 10, default: null, simulated_default: 0, help: '' }],
  });
  expect(defaultsOf(offeredOn(parameters, true))).toEqual({ bob_density_kg_m3: 0 });
  expect(defaultsOf(offeredOn(parameters, false))).toEqual({});
  expect(groupParameters(parameters, true).first[0]?.default).toBe(0);
  expect(groupParameters(parameters, false).more[0]?.default).toBe(null);
});
