import { humanise } from './words';

export interface Fact {
  label: string;
  value: string;
  /** 0 for what stands at the top. */
  depth: number;
}

/** Nested provenance as a flat list to read: `{program: {version: "1"}}` → `Program, version: 1`. */
export function facts(provenance: Record<string, unknown>, prefix = '', depth = 0): Fact[] {
  return Object.entries(provenance).flatMap(([key, value]) => {
    const name = key.replaceAll('_', ' ');
    const label = prefix ? `${prefix}, ${name}` : humanise(key);
    if (value === null || value === undefined || value === '') return [];
    if (typeof value === 'object' && !Array.isArray(value)) return facts(value as Record<string, unknown>, label, depth + 1);
    return [{ label, value: Array.isArray(value) ? value.map(plain).join(', ') : plain(value), depth }];
  });
}

function plain(value: unknown): string {
  return typeof value === 'object' ? JSON.stringify(value) : String(value);
}
