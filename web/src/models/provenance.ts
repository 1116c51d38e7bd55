import { dateTime, viewerZone, zoneName } from './time';
import { humanise } from './words';

export interface Fact {
  label: string;
  value: string;
  /** Among the few that everybody wants to see; the others are for those who check. */
  first: boolean;
}

const everybodyWants = ['program', 'version', 'rig', 'source', 'started'];

/** Nested provenance as a flat list to read: `{camera: {fx: 525}}` → `Camera, fx: 525`. */
export function facts(provenance: Record<string, unknown>, prefix = ''): Fact[] {
  return Object.entries(provenance).flatMap(([key, value]) => {
    const label = prefix ? `${prefix}, ${key.replaceAll('_', ' ')}` : humanise(key);
    if (value === null || value === undefined || value === '') return [];
    if (typeof value === 'object' && !Array.isArray(value)) return facts(value as Record<string, unknown>, label);
    const text = Array.isArray(value) ? value.map(plain).join(', ') : plain(value);
    return [{ label, value: text, first: prefix === '' && everybodyWants.includes(key) }];
  });
}

function plain(value: unknown): string {
  if (typeof value === 'string' && /^\d{4}-\d\d-\d\dT\d\d:\d\d.*Z$/.test(value) && !Number.isNaN(Date.parse(value))) return localTime(Date.parse(value));
  return typeof value === 'object' ? JSON.stringify(value) : String(value);
}

/** On the viewer's clock as everywhere else on the page, with the zone, since this is what one copies into a report. */
function localTime(at: number): string {
  const zone = viewerZone();
  return `${dateTime(at, zone)}, ${zoneName(zone, at)}`;
}
