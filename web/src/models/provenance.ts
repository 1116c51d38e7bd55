import { humanise } from './words';

export interface Fact {
  label: string;
  value: string;
}

/** Nested provenance as a flat list to read: `{program: {version: "1"}}` → `Program, version: 1`. */
export function facts(provenance: Record<string, unknown>, prefix = ''): Fact[] {
  return Object.entries(provenance).flatMap(([key, value]) => {
    const name = key.replaceAll('_', ' ');
    const label = prefix ? `${prefix}, ${name}` : humanise(key);
    if (value === null || value === undefined || value === '') return [];
    if (typeof value === 'object' && !Array.isArray(value)) return facts(value as Record<string, unknown>, label);
    return [{ label, value: Array.isArray(value) ? value.map(plain).join(', ') : plain(value) }];
  });
}

function plain(value: unknown): string {
  return typeof value === 'object' ? JSON.stringify(value) : String(value);
}
