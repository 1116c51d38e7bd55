import { expect, it } from 'vitest';
import { readDefinition } from '../../src/api/experiment';
import { groupParameters, rangeText, readParameters, standing } from '../../src/models/parameters';

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
  expect(names(true)).toEqual(['length_m', 'gravity']);
  expect(names(false)).toEqual(['length_m']);
  expect(rangeText(definition.parameters[0]!)).toBe('0.3 to 1.5');
});

it('refuses a definition from which no field can be built', () => {
  expect(() => readDefinition('pendulum', { parameters: [{ name: 'x' }] })).toThrow('without a name or a default');
  expect(readDefinition('other', null)).toEqual({ id: 'other', title: 'other', summary: '', parameters: [] });
});

it('shows the rig as the last run set it, or else as the definition says', () => {
  expect(standing({ parameters: { length_m: 0.3, bob_radius_m: 0.1 } }, definition.parameters)).toEqual({ length: 0.3, bobRadius: 0.1 });
  expect(standing(null, definition.parameters)).toEqual({ length: 1, bobRadius: 0.05 });
  expect(standing({ parameters: {} }, [])).toEqual({ length: 1, bobRadius: 0.05 });
});
