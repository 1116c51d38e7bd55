/** Where the parts of a pendulum are, in the lab frame (m, z up). Pure. */
import type { Box } from '../models/reach';


/** Height of the pivot above the origin, from where the bob is and how long the pendulum is: the pivot is
 * on the z axis, whatever height the lab frame's origin has. NaN if the bob cannot be there. */
export function pivotHeight(p: readonly [number, number, number], length: number): number {
  return p[2] + Math.sqrt(length * length - p[0] * p[0] - p[1] * p[1]);
}

/** Where somebody stands who looks at `target` from `distance`, angles in radians. */
export function viewpoint(target: readonly [number, number, number], azimuth: number, elevation: number, distance: number): [number, number, number] {
  const level = distance * Math.cos(elevation);
  return [
    target[0] + level * Math.sin(azimuth),
    target[1] - level * Math.cos(azimuth),
    target[2] + distance * Math.sin(elevation),
  ];
}

export interface Framing {
  target: [number, number, number];
  distance: number;
  /** Height of the floor, m. */
  floor: number;
  /** How far the floor reaches from the middle, m. */
  half: number;
}

/** A pendulum is seen whole, with its stand. */
export function pendulumFraming(length: number, radius: number, pivot: number): Framing {
  return { target: [0, 0, pivot - 0.55 * length], distance: 0.9 + 1.5 * length, floor: pivot - length - radius - 0.12, half: 0.4 + 0.45 * length };
}

/** Whatever was seen so far, with room around; a metre or so of the laboratory before anything was. */
export function boxFraming(box: Box | null): Framing {
  if (!box) return { target: [0, 0, 0], distance: 2.4, floor: -0.5, half: 0.9 };
  const middle = box.map((side) => (side.min + side.max) / 2) as [number, number, number];
  const size = Math.max(0.4, ...box.map((side) => side.max - side.min));
  return { target: middle, distance: 0.6 + 1.7 * size, floor: box[2].min - 0.02, half: 0.3 + 0.65 * size };
}
