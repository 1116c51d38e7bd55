import { expect, it } from 'vitest';
import { facts } from '../../src/models/provenance';

it('tells times on the viewer’s clock, with the zone', () => {
  const [started, version] = facts({ started: '2020-06-01T09:00:00Z', version: '1.2.3' });
  expect(started?.value).not.toContain('T09');
  expect(started?.value).toMatch(/2020, \d\d:00, \S/);
  expect(version?.value).toBe('1.2.3');
});
