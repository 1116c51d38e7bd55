import { describe, expect, it } from 'vitest';
import { inWords, objectsInWords, parameterLabel, parameterUnit, rigBadge } from '../../src/models/words';

describe('a sentence of the server', () => {
  it('names no field', () => {
    expect(inWords("g = 1.620 m/s² is not found on the Earth's ground; is length_m right?")).toContain('is the length right?');
    expect(inWords('parameters.amplitude_deg is 9')).toBe('the starting angle is 9');
    expect(inWords('duration_s is long')).toBe('how long to measure is long');
  });

  it('keeps all else', () => {
    expect(inWords('gravity and some_thing, 9.81 m/s²')).toBe('gravity and some_thing, 9.81 m/s²');
  });
});

describe('the badge of a rig', () => {
  it('is green only where the rig can be had', () => {
    expect(rigBadge({ state: 'idle', sentence: 'Free' })).toEqual({ word: 'Free', tone: 'good' });
    expect(rigBadge({ state: 'idle', sentence: 'Free for 20 min' }).tone).toBe('good');
    expect(rigBadge({ state: 'idle', sentence: 'Booked for another 50 min' })).toEqual({ word: 'Booked', tone: '' });
    expect(rigBadge({ state: 'idle', sentence: 'Needs attention: the bob hangs askew' }).tone).toBe('bad');
  });

  it('says whose it is, unless it is off or in use', () => {
    expect(rigBadge({ state: 'idle', sentence: 'Booked for another 50 min' }, true).word).toBe('Yours now');
    expect(rigBadge({ state: 'offline', sentence: 'Offline' }, true).word).toBe('Switched off');
    expect(rigBadge({ state: 'busy', sentence: 'Measuring' }, true).word).toBe('In use');
  });
});

describe('names', () => {
  it('lose their unit, and say what is uncertain', () => {
    expect([parameterLabel('string_mass_kg'), parameterUnit('string_mass_kg')]).toEqual(['String mass', 'kg']);
    expect(parameterLabel('string_mass_u_kg')).toBe('Uncertainty of the string mass');
    expect([parameterLabel('stiffness_n_m'), parameterUnit('stiffness_n_m')]).toEqual(['Stiffness', 'N/m']);
    expect(parameterUnit('gravity')).toBe('m/s²');
  });

  it('of what is watched make a sentence', () => {
    expect(objectsInWords([])).toBe('what moves');
    expect(objectsInWords(['bob'])).toBe('the bob');
    expect(objectsInWords(['ball_a', 'ball_b', 'wall'])).toBe('ball a, ball b and wall');
  });
});
