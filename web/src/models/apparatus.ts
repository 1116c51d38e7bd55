/** What is known of an apparatus beyond its definition: only how it is best looked at. One that is not
 * listed here is shown all the same, from general choices. */

import type { ExperimentDefinition } from '../api/experiment';

export type Direction = 'x' | 'y' | 'z';
export type Plane = 'above' | 'side' | 'front';

export interface Look {
  /** Which positions the live plot shows at first. */
  directions: Direction[];
  /** From where the path is seen at first. */
  plane: Plane;
}

const fromAbove: Look = { directions: ['x', 'y'], plane: 'above' };
const fromTheSide: Look = { directions: ['x', 'z'], plane: 'side' };

const looks: Record<string, Look> = {
  pendulum: fromAbove,
  foucault: fromAbove,
  projectile: fromTheSide,
  free_fall: fromTheSide,
  incline: fromTheSide,
  spring: { directions: ['z'], plane: 'side' },
  collision: fromAbove,
  robot: fromAbove,
  tumbler: { directions: ['x', 'y', 'z'], plane: 'front' },
};

type Kind = Pick<ExperimentDefinition, 'id' | 'apparatus' | 'analysis'>;

/** The name under which something is kept for an experiment: its analysis' or its apparatus'. */
export function kindOf(experiment: Kind | null, known: readonly string[]): string | null {
  if (!experiment) return null;
  return [experiment.analysis.method, experiment.apparatus, experiment.id].find((name) => known.includes(name)) ?? null;
}

export function lookOf(experiment: Kind | null): Look {
  return looks[kindOf(experiment, Object.keys(looks)) ?? ''] ?? { directions: ['x', 'y', 'z'], plane: 'above' };
}

/** Right and up in each plane, as indices of x, y, z. */
export const planes: Record<Plane, { label: string; right: 0 | 1; up: 1 | 2 }> = {
  above: { label: 'From above', right: 0, up: 1 },
  side: { label: 'From the side', right: 0, up: 2 },
  front: { label: 'Along x', right: 1, up: 2 },
};
