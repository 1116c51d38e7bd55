/** Times in the viewer's zone, durations in words. */

export const second = 1000;
export const minute = 60 * second;
export const hour = 60 * minute;
export const day = 24 * hour;

export function viewerZone(): string {
  return new Intl.DateTimeFormat().resolvedOptions().timeZone || 'UTC';
}

/** `Europe/Berlin (CET)`: the zone by name, with the abbreviation that holds at that time. */
export function zoneName(zone: string, at: number, locale?: string): string {
  const part = new Intl.DateTimeFormat(locale, { timeZone: zone, timeZoneName: 'short' })
    .formatToParts(at)
    .find((p) => p.type === 'timeZoneName')?.value;
  const place = zone.replaceAll('_', ' ');
  return part && part !== place ? `${place} (${part})` : place;
}

export function clockTime(at: number, zone = viewerZone(), locale?: string): string {
  return new Intl.DateTimeFormat(locale, { timeZone: zone, hour: '2-digit', minute: '2-digit', hourCycle: 'h23' }).format(at);
}

export function dayName(at: number, zone = viewerZone(), now = Date.now(), locale?: string): string {
  const key = (t: number) => new Intl.DateTimeFormat('en-CA', { timeZone: zone }).format(t);
  if (key(at) === key(now)) return 'today';
  if (key(at) === key(now + day)) return 'tomorrow';
  if (key(at) === key(now - day)) return 'yesterday';
  return new Intl.DateTimeFormat(locale, { timeZone: zone, weekday: 'short', day: 'numeric', month: 'short' }).format(at);
}

/** `today, 10:30–11:00` */
export function slotText(start: number, end: number, zone = viewerZone(), now = Date.now()): string {
  return `${dayName(start, zone, now)}, ${clockTime(start, zone)}\u2013${clockTime(end, zone)}`;
}

/** `22 Nov 2026, 10:31` */
export function dateTime(at: number, zone = viewerZone(), locale?: string): string {
  const date = new Intl.DateTimeFormat(locale, { timeZone: zone, day: 'numeric', month: 'short', year: 'numeric' }).format(at);
  return `${date}, ${clockTime(at, zone, locale)}`;
}

/** The server writes times in UTC; people read their own clock. */
export function localTimes(text: string): string {
  return text.replace(/\d{4}-\d\d-\d\dT\d\d:\d\d(:\d\d(\.\d+)?)?Z/g, (stamp) => {
    const at = Date.parse(stamp);
    return `${clockTime(at)} ${dayName(at)}`;
  });
}

/** A length of time in words, at most two units: `1 h 5 min`, `4 min`, `12 s`. */
export function duration(ms: number): string {
  const s = Math.max(0, Math.round(ms / second));
  if (s < 60) return `${s}\u00a0s`;
  const m = Math.round(s / 60);
  if (m < 60) return `${m}\u00a0min`;
  const h = Math.floor(m / 60);
  if (h < 24) return m % 60 ? `${h}\u00a0h ${m % 60}\u00a0min` : `${h}\u00a0h`;
  const d = Math.floor(h / 24);
  return h % 24 ? `${d}\u00a0d ${h % 24}\u00a0h` : `${d}\u00a0d`;
}

/** A countdown that moves each second once less than ten minutes are left: `9:05`. */
export function countdown(ms: number): string {
  const s = Math.max(0, Math.ceil(ms / second));
  if (s >= 600) return duration(ms);
  return `${Math.floor(s / 60)}:${String(s % 60).padStart(2, '0')}`;
}

/** How old the data are, in words; null while there is nothing to say (half a second or less). */
export function ageSentence(ms: number): string | null {
  if (!Number.isFinite(ms) || ms <= 500) return null;
  if (ms < 2 * second) return 'What you see is about a second old.';
  if (ms < minute) return `What you see is ${Math.round(ms / second)} seconds old.`;
  return `What you see is ${duration(ms)} old.`;
}
