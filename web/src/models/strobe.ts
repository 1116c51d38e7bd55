/** Experiments as a stroboscope shows them: equal times between the pictures, so that things crowd where
 * they are slow and thin out where they are fast. On a sheet of 360 by 220. Pure. */
import type { ExperimentDefinition } from '../api/experiment';
import { kindOf } from './apparatus';

export type Mark =
  | { kind: 'ball'; x: number; y: number; r: number; strength: number; second?: boolean }
  | { kind: 'box'; x: number; y: number; width: number; height: number; angle: number; strength: number }
  | { kind: 'bar' | 'thread'; path: string; strength: number };

type Picture = () => Mark[];

const steps = (n: number) => Array.from({ length: n }, (_, i) => i / (n - 1));
const fading = (s: number) => 0.12 + 0.88 * s * s;
const bar = (path: string): Mark => ({ kind: 'bar', path, strength: 1 });

const pendulum: Picture = () => {
  const length = 160;
  const at = (s: number) => -0.62 * Math.cos(Math.PI * s);
  const places = steps(13).map((s) => ({ s, x: 180 + length * Math.sin(at(s)), y: 22 + length * Math.cos(at(s)) }));
  return [
    bar('M90 22h180'),
    ...places.map(({ s, x, y }): Mark => ({ kind: 'thread', path: `M180 22L${x} ${y}`, strength: 0.7 * fading(s) })),
    ...places.map(({ s, x, y }): Mark => ({ kind: 'ball', x, y, r: 14, strength: fading(s) })),
  ];
};

/** From above: the plane of the swing turns. */
const foucault: Picture = () => {
  const place = (s: number) => {
    const swing = 90 * Math.cos(2 * Math.PI * 4.5 * s);
    const turned = -1.3 * s + 0.4;
    return { x: 180 + swing * Math.cos(turned), y: 110 + swing * Math.sin(turned) };
  };
  const path = steps(240).map((s, i) => `${i === 0 ? 'M' : 'L'}${place(s).x.toFixed(1)} ${place(s).y.toFixed(1)}`).join('');
  return [{ kind: 'thread', path, strength: 0.6 }, ...[0.955, 0.97, 0.985, 1].map((s): Mark => ({ kind: 'ball', ...place(s), r: 12, strength: fading((s - 0.94) / 0.06) }))];
};

const projectile: Picture = () =>
  [bar('M30 206h300'), ...steps(12).map((s): Mark => ({ kind: 'ball', x: 45 + 265 * s, y: 190 - 4 * 150 * s * (1.06 - s), r: 11, strength: fading(s) }))];

const incline: Picture = () =>
  [bar('M40 66L320 200H40'), ...steps(9).map((s): Mark => ({ kind: 'ball', x: 62 + 230 * s * s, y: 60 + 110 * s * s, r: 13, strength: fading(s) }))];

const spring: Picture = () => {
  const coil = (bottom: number) => {
    const turns = steps(15).map((s, i) => `L${i === 0 || i === 14 ? 180 : i % 2 ? 162 : 198} ${(24 + (bottom - 24) * s).toFixed(1)}`);
    return `M180 18${turns.join('')}`;
  };
  const heights = steps(7).map((s) => ({ s, y: 130 - 42 * Math.cos(Math.PI * s) }));
  return [
    bar('M120 18h120'), { kind: 'thread', path: coil(158), strength: 1 },
    ...heights.map(({ s, y }): Mark => ({ kind: 'ball', x: 180, y, r: 17, strength: fading(s) })),
  ];
};

const collision: Picture = () => [
  ...steps(5).map((s): Mark => ({ kind: 'ball', x: 40 + 118 * s, y: 110, r: 14, strength: fading(0.2 + 0.5 * s) })),
  ...steps(4).map((s): Mark => ({ kind: 'ball', x: 160 + 70 * s, y: 110 - 62 * s, r: 14, strength: fading(0.4 + 0.6 * s) })),
  ...steps(5).map((s): Mark => ({ kind: 'ball', x: 184 + 122 * s, y: 118 + 64 * s, r: 14, strength: fading(0.3 + 0.7 * s), second: true })),
];

const robot: Picture = () => {
  const place = (s: number) => ({ x: 50 + 260 * s, y: 110 + 62 * Math.sin(5.2 * s) });
  const heading = (s: number) => (Math.atan2(62 * 5.2 * Math.cos(5.2 * s), 260) * 180) / Math.PI;
  const path = steps(60).map((s, i) => `${i === 0 ? 'M' : 'L'}${place(s).x.toFixed(1)} ${place(s).y.toFixed(1)}`).join('');
  return [{ kind: 'thread', path, strength: 0.8 }, ...steps(6).map((s): Mark => ({ kind: 'box', ...place(s), width: 40, height: 26, angle: heading(s), strength: fading(s) }))];
};

const tumbler: Picture = () =>
  steps(6).map((s): Mark => ({ kind: 'box', x: 60 + 240 * s, y: 150 - 320 * s * (0.95 - s), width: 62 - 20 * Math.abs(Math.sin(4 * s)), height: 34, angle: 200 * s, strength: fading(s) }));

const pictures: Record<string, Picture> = { pendulum, foucault, projectile, free_fall: projectile, incline, spring, collision, robot, tumbler };

/** Of an apparatus that is not drawn here: something that moves on, faster and faster. */
const something: Picture = () => steps(8).map((s): Mark => ({ kind: 'ball', x: 50 + 260 * s * s, y: 110, r: 14, strength: fading(s) }));

export function strobe(experiment: Pick<ExperimentDefinition, 'id' | 'apparatus' | 'analysis'> | null): Mark[] {
  return (pictures[kindOf(experiment, Object.keys(pictures)) ?? ''] ?? something)();
}

/** For the door, where nothing was chosen yet. */
export const doorPicture = pendulum;
