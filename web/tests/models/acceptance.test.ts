import { expect, it } from 'vitest';
import { checkLine, ruleLine, verdict } from '../../src/models/acceptance';

const plain = <T>(value: T): T => JSON.parse(JSON.stringify(value).replaceAll('\u202f', ' ')) as T;

it('says what was wanted and what was found, in units that people read', () => {
  const amplitude = { name: 'amplitude', value: 0.5, u: 0.01, unit: 'rad' };
  const missed = { fact: 'amplitude', value: Math.PI / 2, min: Math.PI / 180, max: Math.PI / 3, ok: false, reason: 'Too wide.' };
  expect(plain(checkLine(missed, [amplitude]))).toEqual({ label: 'Amplitude at the start', ok: false, found: '90 °', wanted: '1 ° to 60 °', reason: 'Too wide.' });
  expect(plain(checkLine({ fact: 'tracked_share', value: 0.955, min: 0.8, ok: true, reason: 'Hidden.' }, []))).toMatchObject({ found: '95.5 %', wanted: 'at least 80 %', reason: '' });
});

it('a fact that the run does not tell is not known', () => {
  expect(checkLine({ fact: 'periods', value: null, min: 10, ok: false, reason: 'Few.' }, [])).toMatchObject({ found: 'not known', wanted: 'at least 10' });
});

it('claims nothing of a result that was never checked', () => {
  expect([verdict({}), verdict({ accepted: true }), verdict({ accepted: false })]).toEqual(['unknown', 'good', 'not-good']);
});

it('tells limits beforehand only where their unit is known', () => {
  expect(ruleLine({ fact: 'amplitude', min: 0.017, max: 1, reason: '' }).wanted).toBe('');
  expect(plain(ruleLine({ fact: 'duration_s', min: null, max: 60, reason: '' }).wanted)).toBe('at most 60 s');
});
