import { expect, it } from 'vitest';
import { ageSentence, clockTime, countdown, dayName, duration, hour, minute, second, slotText, zoneName } from '../../src/models/time';

const at = Date.UTC(2026, 10, 22, 9, 0);

it('says a length of time in words', () => {
  const words = [0, 12 * second, 4 * minute, 65 * minute, 120 * minute, 26 * hour].map((ms) => duration(ms).replaceAll('\u00a0', ' '));
  expect(words).toEqual(['0 s', '12 s', '4 min', '1 h 5 min', '2 h', '1 d 2 h']);
});

it('counts down by seconds in the last ten minutes', () => {
  expect(countdown(545 * second)).toBe('9:05');
  expect(countdown(400)).toBe('0:01');
  expect(countdown(-5)).toBe('0:00');
  expect(countdown(hour).replaceAll('\u00a0', ' ')).toBe('1 h');
});

it('shows times in the given zone', () => {
  expect(clockTime(at, 'Europe/Berlin')).toBe('10:00');
  expect(clockTime(at, 'America/New_York')).toBe('04:00');
  expect(zoneName('America/New_York', at, 'en')).toBe('America/New York (EST)');
  expect(zoneName('UTC', at, 'en')).toBe('UTC');
});

it('names the day as the viewer lives it', () => {
  const late = Date.UTC(2026, 10, 22, 23, 30);
  expect(dayName(late, 'UTC', at)).toBe('today');
  expect(dayName(late, 'Europe/Berlin', at)).toBe('tomorrow');
  expect(slotText(at, at + 30 * minute, 'Europe/Berlin', at)).toBe('today, 10:00–10:30');
});

it('says how old the data are only when they are older than half a second', () => {
  expect(ageSentence(NaN)).toBeNull();
  expect(ageSentence(500)).toBeNull();
  expect(ageSentence(501)).toContain('about a second');
  expect(ageSentence(12 * second)).toContain('12 seconds');
  expect(ageSentence(3 * minute)).toContain('3\u00a0min');
});
