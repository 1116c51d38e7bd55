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
  return typeof value === 'object' ? JSON.stringify(value) : String(value);
}
