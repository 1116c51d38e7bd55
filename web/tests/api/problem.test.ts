import { expect, it } from 'vitest';
import { fieldMessage, formMessage, problemToError } from '../../src/api/problem';

const errors = [{ field: 'parameters.length_m', message: 'is 9', cure: 'give a number from 0.3 to 1.5' }];

it('shows an error at its field, with the cure', () => {
  const error = problemToError(422, { status: 422, detail: 'length_m: is 9', errors });
  expect(fieldMessage(error, 'parameters.length_m')).toBe('Is 9; give a number from 0.3 to 1.5.');
  expect(fieldMessage(error, 'parameters.gravity')).toBeNull();
  expect(formMessage(error, ['parameters.length_m'])).toBeNull();
  expect(formMessage(error, ['parameters.gravity'])).toBe('Length is 9; give a number from 0.3 to 1.5.');
});

it('says who or what, where no field does', () => {
  const spoken = (field: string, message: string) => problemToError(409, { detail: `${field}: ${message}`, errors: [{ field, message, cure: 'wait' }] }).message;
  expect(spoken('rig', 'is busy with another run')).toBe('The rig is busy with another run; wait.');
  expect(spoken('user', 'holds 5 bookings')).toBe('Your account holds 5 bookings; wait.');
  expect(spoken('start', 'the rig is taken')).toBe('The rig is taken; wait.');
});

it('tells times on the viewer’s clock', () => {
  const error = problemToError(403, { detail: 'the slot begins at 2020-06-01T09:00:00Z' });
  expect(error.message).not.toContain('2020-06-01T');
  expect(error.message).toMatch(/\d\d:00 .*1/);
});

it('keeps the alternatives of a conflict, and drops what is malformed', () => {
  const slot = { rig: 'rig-2', start: '2026-11-22T09:00:00Z', end: '2026-11-22T09:30:00Z' };
  const error = problemToError(409, { detail: 'the rig is taken', alternatives: [slot, { rig: 1 }, null], errors: ['x', null] });
  expect(error.alternatives).toEqual([slot]);
  expect(error.errors).toEqual([]);
  expect(error.message).toBe('The rig is taken.');
});

it.each([[null], ['<html>'], [{}], [[]]])('has a sentence even for a body of %j', (body) => {
  expect(problemToError(503, body).message).toContain('The rig does not answer');
  expect(problemToError(500, body).message).toContain('500');
});

it('keeps calls of the programming interface from people', () => {
  const errors = [{ field: 'rig', message: "there is no rig 'nope'", cure: 'GET /api/v1/rigs lists them' }];
  const detail = "rig: there is no rig 'nope'; GET /api/v1/rigs lists them";
  expect(problemToError(404, { detail, errors }).message).toBe("There is no rig 'nope'.");
  expect(problemToError(404, { detail: "there is no rig 'nope'; GET /api/v1/rigs lists them" }).message).toBe("There is no rig 'nope'.");
});
