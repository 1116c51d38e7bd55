/** The booking calendar as values: which pieces of a local day there are, and which of them are free.
 * Days are those of the viewer's zone: on the two days on which clocks change they last 23 or 25 hours. */
import type { Booking } from '../api/types';
import { day, minute } from './time';

/** Slots start and end on whole 5 minutes. */
export const grain = 5 * minute;
export const longest = 120 * minute;
export const horizonDays = 30;

export interface LocalDate {
  year: number;
  month: number;
  day: number;
}

export interface Cell {
  start: number;
  end: number;
  /** Wall clock at its start, `02:30`. */
  label: string;
  /** 1 for the second 02:30 of the night on which clocks go back. */
  occurrence: number;
}

export type CellState = 'past' | 'free' | 'partly' | 'taken' | 'mine' | 'beyond';

export interface Interval {
  start: number;
  end: number;
}

export function localDate(at: number, zone: string): LocalDate {
  const p = wallParts(at, zone);
  return { year: p.year, month: p.month, day: p.day };
}

export function addDays(date: LocalDate, days: number): LocalDate {
  const moved = new Date(Date.UTC(date.year, date.month - 1, date.day + days));
  return { year: moved.getUTCFullYear(), month: moved.getUTCMonth() + 1, day: moved.getUTCDate() };
}

/** The first instant of a local day; midnight itself where it exists (some zones change clocks at midnight). */
export function startOfDay(date: LocalDate, zone: string): number {
  const wall = Date.UTC(date.year, date.month - 1, date.day);
  // Between the guess and midnight the clocks may change, by whole half hours, or skip midnight.
  let at = wall - offset(wall, zone);
  while (localDate(at, zone).day !== date.day) at += 30 * minute;
  while (localDate(at - 30 * minute, zone).day === date.day) at -= 30 * minute;
  return at;
}

/** A local day cut into pieces of `step`, in the order in which they happen. */
export function dayCells(date: LocalDate, zone: string, step = 30 * minute): Cell[] {
  const begin = startOfDay(date, zone);
  const end = startOfDay(addDays(date, 1), zone);
  const cells: Cell[] = [];
  const seen = new Map<string, number>();
  for (let t = begin; t < end; t += step) {
    const p = wallParts(t, zone);
    const label = `${pad(p.hour)}:${pad(p.minute)}`;
    const occurrence = seen.get(label) ?? 0;
    seen.set(label, occurrence + 1);
    cells.push({ start: t, end: Math.min(t + step, end), label, occurrence });
  }
  return cells;
}

export interface Row {
  label: string;
  occurrence: number;
  /** One for each day; null where this wall-clock time does not happen on that day. */
  cells: (Cell | null)[];
}

/** Days side by side: a row for every wall-clock time that happens on any of them. */
export function gridRows(days: LocalDate[], zone: string, step = 30 * minute): Row[] {
  const rows = new Map<string, Row>();
  days.forEach((date, column) => {
    for (const cell of dayCells(date, zone, step)) {
      const key = `${cell.label}/${cell.occurrence}`;
      let row = rows.get(key);
      if (!row) {
        row = { label: cell.label, occurrence: cell.occurrence, cells: days.map(() => null) };
        rows.set(key, row);
      }
      row.cells[column] = cell;
    }
  });
  // The repeated hour follows the whole first one: 02:00 02:30 02:00 02:30 03:00.
  const order = (r: Row) => (r.occurrence === 0 ? r.label : `${r.label.slice(0, 2)}~${r.occurrence}${r.label.slice(3)}`);
  return [...rows.values()].sort((a, b) => (order(a) < order(b) ? -1 : 1));
}

export function bookingInterval(booking: { start: string; end: string }): Interval {
  return { start: Date.parse(booking.start), end: Date.parse(booking.end) };
}

/** What a cell looks like to the viewer. */
export function cellState(cell: Interval, bookings: Booking[], now: number): CellState {
  if (cell.end <= now) return 'past';
  if (cell.start >= now + horizonDays * day) return 'beyond';
  let covered = 0;
  let usableFrom = cell.start;
  // What is over of the current cell is neither free nor taken.
  const current = Math.max(cell.start, floorToGrain(now));
  usableFrom = current;
  for (const booking of bookings) {
    const b = bookingInterval(booking);
    const overlap = Math.min(cell.end, b.end) - Math.max(usableFrom, b.start);
    if (overlap <= 0) continue;
    if (booking.mine) return 'mine';
    covered += overlap;
  }
  if (covered === 0) return 'free';
  return covered >= cell.end - usableFrom ? 'taken' : 'partly';
}

/** The first moment at or after `from` at which a slot can start, and the longest it can last from
 * there; null if nothing of `atLeast` is free before `until`. */
export function nextFree(bookings: Booking[], from: number, atLeast: number, until: number): Interval | null {
  const taken = bookings.map(bookingInterval).sort((a, b) => a.start - b.start);
  let start = floorToGrain(from);
  for (const slot of [...taken, { start: Infinity, end: Infinity }]) {
    if (slot.end <= start) continue;
    if (slot.start - start >= atLeast) {
      if (start >= until) return null;
      return { start, end: start + Math.min(longest, slot.start - start) };
    }
    start = Math.max(start, ceilToGrain(slot.end));
  }
  return null;
}

/** All starts inside a cell, on whole 5 minutes, from which at least 5 minutes are free. */
export function startsIn(cell: Interval, bookings: Booking[], now: number): number[] {
  const starts: number[] = [];
  for (let t = Math.max(ceilToGrain(cell.start), floorToGrain(now)); t < cell.end; t += grain) {
    if (longestFrom(t, bookings) >= grain) starts.push(t);
  }
  return starts;
}

/** How long a slot that starts at `start` can last; 0 if somebody has it already. */
export function longestFrom(start: number, bookings: Booking[]): number {
  let end = start + longest;
  for (const booking of bookings) {
    const b = bookingInterval(booking);
    if (b.start <= start && start < b.end) return 0;
    if (b.start > start) end = Math.min(end, b.start);
  }
  return end - start;
}

/** Whether all of it can still be booked: what somebody else took meanwhile, or what is over, cannot. */
export function canBook(slot: Interval, bookings: Booking[], now: number): boolean {
  return slot.end > slot.start && slot.end - slot.start <= longestFrom(slot.start, bookings) && slot.start + grain > now;
}

/** The lengths to choose from. */
export function lengthsUpTo(most: number): number[] {
  return [5, 10, 15, 20, 30, 45, 60, 90, 120].map((m) => m * minute).filter((ms) => ms <= most);
}

export function floorToGrain(at: number): number {
  return Math.floor(at / grain) * grain;
}

export function ceilToGrain(at: number): number {
  return Math.ceil(at / grain) * grain;
}

interface WallParts extends LocalDate {
  hour: number;
  minute: number;
  second: number;
}

const formats = new Map<string, Intl.DateTimeFormat>();

function wallParts(at: number, zone: string): WallParts {
  let format = formats.get(zone);
  if (!format) {
    format = new Intl.DateTimeFormat('en', {
      timeZone: zone, hourCycle: 'h23', year: 'numeric', month: 'numeric', day: 'numeric',
      hour: 'numeric', minute: 'numeric', second: 'numeric',
    });
    formats.set(zone, format);
  }
  const parts: Record<string, number> = {};
  for (const part of format.formatToParts(at)) parts[part.type] = Number(part.value);
  return {
    year: parts['year'] ?? 0, month: parts['month'] ?? 1, day: parts['day'] ?? 1,
    hour: parts['hour'] ?? 0, minute: parts['minute'] ?? 0, second: parts['second'] ?? 0,
  };
}

/** Wall clock minus UTC, ms. */
function offset(at: number, zone: string): number {
  const p = wallParts(at, zone);
  const wall = Date.UTC(p.year, p.month - 1, p.day, p.hour, p.minute, p.second);
  return Math.round((wall - Math.floor(at / 1000) * 1000) / minute) * minute;
}

function pad(n: number): string {
  return String(n).padStart(2, '0');
}

