/** Where the parts of a pendulum are, in the lab frame (m, z up). Pure. */

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
