import { describe, expect, it } from 'vitest';
import type { Booking } from '../../src/api/types';
import {
  addDays, canBook, cellState, dayCells, gridRows, horizonDays, lengthsUpTo, localDate, longestFrom, nextFree, startOfDay, startsIn,
} from '../../src/models/slots';
import { day, hour, minute } from '../../src/models/time';

const berlin = 'Europe/Berlin';
const utc = (text: string) => Date.parse(text);

function booking(start: string, end: string, mine = false): Booking {
  return { id: 1, rig: 'rig-1', experiment: 'pendulum', start, end, mine, user: null };
}

describe('local days', () => {
  it('last 24 hours as a rule', () => {
    const cells = dayCells({ year: 2026, month: 11, day: 22 }, berlin);
    expect(cells).toHaveLength(48);
    expect(cells[0]?.start).toBe(utc('2026-11-21T23:00:00Z'));
    expect(cells[20]?.label).toBe('10:00');
  });

  it('have no 02:30 when clocks go forward', () => {
    const cells = dayCells({ year: 2026, month: 3, day: 29 }, berlin);
    expect(cells).toHaveLength(46);
    expect(cells.map((c) => c.label)).not.toContain('02:30');
    expect(new Set(cells.map((c) => c.start)).size).toBe(46);
  });

  it('have 02:00 and 02:30 twice when clocks go back, an hour apart', () => {
    const cells = dayCells({ year: 2026, month: 10, day: 25 }, berlin);
    expect(cells).toHaveLength(50);
    const twice = cells.filter((c) => c.label === '02:30');
    expect(twice.map((c) => c.occurrence)).toEqual([0, 1]);
    expect((twice[1]?.start ?? 0) - (twice[0]?.start ?? 0)).toBe(hour);
  });

  it('begin at 01:00 where clocks change at midnight', () => {
    const date = { year: 2026, month: 9, day: 6 };
    expect(localDate(startOfDay(date, 'America/Santiago'), 'America/Santiago')).toEqual(date);
    const cells = dayCells(date, 'America/Santiago');
    expect(cells[0]?.label).toBe('01:00');
    expect(cells).toHaveLength(46);
  });

  it('fit without gap or overlap over a whole year, in zones with odd offsets', () => {
    for (const zone of [berlin, 'Australia/Lord_Howe', 'Asia/Kathmandu', 'America/St_Johns', 'America/Santiago', 'Pacific/Auckland']) {
      let date = { year: 2026, month: 1, day: 1 };
      let expected = startOfDay(date, zone);
      for (let i = 0; i < 366; i++) {
        const cells = dayCells(date, zone);
        expect(cells[0]?.start).toBe(expected);
        expect(cells[0]?.label).toBe(zone === 'America/Santiago' && date.month === 9 && date.day === 6 ? '01:00' : '00:00');
        expected = cells[cells.length - 1]?.end ?? 0;
        date = addDays(date, 1);
      }
    }
  });

  it('are counted across months and leap days', () => {
    expect(addDays({ year: 2028, month: 2, day: 28 }, 1)).toEqual({ year: 2028, month: 2, day: 29 });
    expect(addDays({ year: 2026, month: 12, day: 31 }, 1)).toEqual({ year: 2027, month: 1, day: 1 });
  });
});

it('puts the repeated hour after the first one, and leaves a hole on the other days', () => {
  const rows = gridRows([{ year: 2026, month: 10, day: 24 }, { year: 2026, month: 10, day: 25 }], berlin);
  expect(rows.slice(4, 9).map((r) => `${r.label}/${r.occurrence}`)).toEqual(['02:00/0', '02:30/0', '02:00/1', '02:30/1', '03:00/0']);
  expect(rows[6]?.cells[0]).toBeNull();
  expect(rows[6]?.cells[1]?.label).toBe('02:00');
  const starts = rows.map((r) => r.cells[1]?.start ?? 0);
  expect([...starts].sort((a, b) => a - b)).toEqual(starts);
});

describe('cells', () => {
  const now = utc('2026-11-22T09:07:00Z');
  const cell = (start: string) => ({ start: utc(start), end: utc(start) + 30 * minute });

  it('are over, free, partly taken, taken, yours or too far ahead', () => {
    const bookings = [
      booking('2026-11-22T10:00:00Z', '2026-11-22T10:30:00Z'),
      booking('2026-11-22T11:00:00Z', '2026-11-22T11:10:00Z'),
      booking('2026-11-22T12:00:00Z', '2026-11-22T12:05:00Z', true),
    ];
    expect(cellState(cell('2026-11-22T08:30:00Z'), bookings, now)).toBe('past');
    expect(cellState(cell('2026-11-22T09:00:00Z'), bookings, now)).toBe('free');
    expect(cellState(cell('2026-11-22T10:00:00Z'), bookings, now)).toBe('taken');
    expect(cellState(cell('2026-11-22T10:30:00Z'), bookings, now)).toBe('free');
    expect(cellState(cell('2026-11-22T11:00:00Z'), bookings, now)).toBe('partly');
    expect(cellState(cell('2026-11-22T12:00:00Z'), bookings, now)).toBe('mine');
    expect(cellState({ start: now + horizonDays * day, end: now + horizonDays * day + hour }, [], now)).toBe('beyond');
  });

  it('forget what is over of the current one', () => {
    expect(cellState(cell('2026-11-22T09:00:00Z'), [booking('2026-11-22T09:00:00Z', '2026-11-22T09:05:00Z')], now)).toBe('free');
  });
});

describe('free time', () => {
  const now = utc('2026-11-22T09:07:00Z');
  const bookings = [booking('2026-11-22T09:10:00Z', '2026-11-22T10:00:00Z'), booking('2026-11-22T10:05:00Z', '2026-11-22T11:00:00Z')];

  it('begins with the five minutes that are running', () => {
    expect(nextFree([], now, 30 * minute, now + day)).toEqual({ start: utc('2026-11-22T09:05:00Z'), end: utc('2026-11-22T11:05:00Z') });
  });

  it('is looked for behind what is taken, long enough', () => {
    expect(nextFree(bookings, now, 5 * minute, now + day)?.start).toBe(utc('2026-11-22T09:05:00Z'));
    expect(nextFree(bookings, now, 10 * minute, now + day)?.start).toBe(utc('2026-11-22T11:00:00Z'));
    expect(nextFree(bookings, now, 10 * minute, now + hour)).toBeNull();
  });

  it('offers starts on whole five minutes, none of them taken or over', () => {
    const cell = { start: utc('2026-11-22T10:00:00Z'), end: utc('2026-11-22T10:30:00Z') };
    expect(startsIn(cell, bookings, now)).toEqual([utc('2026-11-22T10:00:00Z')]);
    const current = { start: utc('2026-11-22T09:00:00Z'), end: utc('2026-11-22T09:30:00Z') };
    expect(startsIn(current, bookings, now)).toEqual([utc('2026-11-22T09:05:00Z')]);
  });

  it('ends at the next booking, or after two hours', () => {
    expect(longestFrom(utc('2026-11-22T10:00:00Z'), bookings)).toBe(5 * minute);
    expect(longestFrom(utc('2026-11-22T09:30:00Z'), bookings)).toBe(0);
    expect(longestFrom(utc('2026-11-22T11:00:00Z'), bookings)).toBe(2 * hour);
    expect(lengthsUpTo(25 * minute).map((ms) => ms / minute)).toEqual([5, 10, 15, 20]);
  });

  it('does not book over what somebody took meanwhile', () => {
    const slot = { start: utc('2026-11-22T10:00:00Z'), end: utc('2026-11-22T10:10:00Z') };
    expect(canBook({ ...slot, end: slot.start + 5 * minute }, bookings, now)).toBe(true);
    expect(canBook(slot, bookings, now)).toBe(false);
  });
});
