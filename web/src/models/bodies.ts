/** From a definition's objects and the values of a run to what the 3-D scene draws. Pure. */
import type { TrackedObject } from '../api/experiment';
import { numberOrNull, record } from '../api/json';

export type Body =
  | { name: string; shape: 'sphere'; radius: number }
  | { name: string; shape: 'cylinder'; radius: number; length: number }
  | { name: string; shape: 'cone'; radius: number; length: number }
  | { name: string; shape: 'box'; size: [number, number, number] };

const usualRadius = 0.05;

export function bodiesOf(objects: readonly TrackedObject[], values: Record<string, number>): Body[] {
  return objects.map((object) => bodyOf(object, values));
}

/** One that the definition does not know is drawn too. */
export function unknownBody(name: string): Body {
  return { name, shape: 'box', size: [0.1, 0.1, 0.1] };
}

function bodyOf({ name, method, settings }: TrackedObject, values: Record<string, number>): Body {
  const radius = () => settingOf(settings['radius_m'], values) ?? usualRadius;
  switch (method) {
    case 'sphere':
      return { name, shape: 'sphere', radius: radius() };
    case 'cylinder':
      return { name, shape: 'cylinder', radius: radius(), length: 4 * radius() };
    case 'cone':
      return { name, shape: 'cone', radius: radius(), length: 2 * radius() };
    case 'plane':
      return { name, shape: 'box', size: [0.4, 0.3, 0.01] };
    default:
      return unknownBody(name);
  }
}

/** A number, or `{"parameter": NAME}` for the run's value of it. */
function settingOf(setting: unknown, values: Record<string, number>): number | null {
  const named = record(setting)['parameter'];
  const value = typeof named === 'string' ? numberOrNull(values[named]) : numberOrNull(setting);
  return value !== null && value > 0 ? value : null;
}
