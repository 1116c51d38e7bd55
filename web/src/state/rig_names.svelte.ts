import * as lab from '../api/lab';

/** What the rigs are called, asked for once: runs and bookings carry only their ids. */
let names = $state.raw<Record<string, string>>({});
let asked = false;

export function rigName(id: string): string {
  if (!asked) {
    asked = true;
    lab.rigs().then(
      (rigs) => (names = Object.fromEntries(rigs.map((r) => [r.id, r.name]))),
      () => (asked = false),
    );
  }
  return names[id] ?? id;
}
