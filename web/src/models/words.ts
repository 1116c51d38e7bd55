/** Names of the wire as a student would say them. */
import type { Rig } from '../api/types';
import { splitName } from './units';

/** Where the name itself would say too little; all others are read as they are written. */
const parameterLabels: Record<string, string> = {
  amplitude_deg: 'Starting angle',
  gravity: 'Gravity',
  damping_per_s: 'Damping',
  duration_s: 'How long to measure',
  incline_deg: 'Slope of the incline',
  drive_hz: 'Frequency of the drive',
  mass_a_kg: 'Mass of ball A',
  mass_b_kg: 'Mass of ball B',
  radius_a_m: 'Radius of ball A',
  radius_b_m: 'Radius of ball B',
};

const quantityLabels: Record<string, string> = {
  g: 'Acceleration of free fall g',
  period: 'Period as it swung',
  small_angle_period: 'Period at a small angle',
  amplitude: 'Amplitude at the start',
  quality_factor: 'Quality factor',
  turning_rate: 'Turning of the swing plane',
  quadratic_damping: 'Quadratic damping',
  precession_rate: 'Turning of the swing plane',
  latitude: 'Latitude',
  ellipse_a: 'Half the length of the ellipse',
  ellipse_b: 'Half the width of the ellipse',
  airy_rate: 'Turning of the ellipse by itself',
  restitution: 'Coefficient of restitution',
  tracked_share: 'Share of frames in which it was seen',
  outlier_share: 'Share of outliers',
  gap_share: 'Share of gaps',
  reduced_chi2: 'Scatter against the expected (reduced χ²)',
  periods: 'Periods seen',
  duration_s: 'Time measured',
};

const quantitySymbols: Record<string, string> = {
  g: 'g', period: 'T', small_angle_period: 'T₀', stiffness: 'k', restitution: 'e', quality_factor: 'Q', acceleration: 'a', latitude: 'φ',
};

const sourceLabels: Record<string, string> = {
  statistics: 'Scatter of the measured points',
  clock: 'Clock of the camera',
  'depth scale': 'Depth scale of the camera',
  'camera tilt': 'Level of the camera',
  'model choice': 'Choice of the law',
  'bob size': 'Unknown size of the bob',
  air: 'Unknown effect of the air',
  string: 'Unknown mass of the string',
};

/** As the experiment's definition has them; names that it lacks follow by the alphabet. */
export function inReadingOrder(parameters: Record<string, number>, definition: readonly { name: string }[] = []): [string, number][] {
  const place = (name: string) => {
    const at = definition.findIndex((p) => p.name === name);
    return at < 0 ? definition.length : at;
  };
  return Object.entries(parameters).sort(([a], [b]) => place(a) - place(b) || a.localeCompare(b));
}

const rigStateWords: Record<Rig['state'], string> = { idle: 'Free', busy: 'In use', offline: 'Switched off' };

export type RigTone = 'good' | 'active' | 'bad' | '';

/** A rig that idles is not free while somebody's slot runs, or while it needs somebody; its sentence says so. */
export function rigBadge(rig: Pick<Rig, 'state' | 'sentence'>, yours = false): { word: string; tone: RigTone } {
  const word = rigStateWords[rig.state];
  if (rig.state === 'offline') return { word, tone: 'bad' };
  if (rig.state === 'busy') return { word, tone: 'active' };
  if (rig.sentence.startsWith('Needs attention')) return { word: 'Needs attention', tone: 'bad' };
  if (yours) return { word: 'Yours now', tone: 'active' };
  return rig.sentence.startsWith('Booked') ? { word: 'Booked', tone: '' } : { word, tone: 'good' };
}

/** `string_mass_kg` → `String mass`, `length_u_m` → `Uncertainty of the length` */
export function parameterLabel(name: string): string {
  const known = parameterLabels[name];
  if (known) return known;
  const { stem } = splitName(name);
  const words = humanise(stem.replace(/_u$/, ''));
  return /_u$/.test(stem) ? `Uncertainty of ${withArticle(words)}` : words;
}

export const parameterUnit = (name: string): string => (name === 'gravity' ? 'm/s²' : splitName(name).unit);
export const quantityLabel = (name: string): string => quantityLabels[name] ?? humanise(name);
export const quantitySymbol = (name: string): string => quantitySymbols[name] ?? '';
export const sourceLabel = (name: string): string => sourceLabels[name] ?? humanise(name);

/** A sentence of the server's without names of the wire: `is length_m right?` → `is the length right?` */
export function inWords(text: string): string {
  return text.replace(/\b(?:parameters\.)?([a-z]+(?:_[a-z0-9]+)+)\b/g, (whole, name: string) => {
    const known = name in parameterLabels || splitName(name).unit !== '';
    return known ? withArticle(parameterLabel(name)) : whole;
  });
}

function withArticle(label: string): string {
  const words = label.charAt(0).toLowerCase() + label.slice(1);
  return words.startsWith('how ') || words === 'damping' ? words : `the ${words}`;
}

/** `small_angle_period` → `Small angle period` */
export function humanise(name: string): string {
  const words = name.replaceAll('_', ' ').trim();
  return words.charAt(0).toUpperCase() + words.slice(1);
}

/** What is watched, for the middle of a sentence: `the bob`, `ball a and ball b`. */
export function objectsInWords(names: readonly string[]): string {
  const words = names.map((name) => name.replaceAll('_', ' '));
  if (words.length === 0) return 'what moves';
  if (words.length === 1) return `the ${words[0]}`;
  return `${words.slice(0, -1).join(', ')} and ${words[words.length - 1]}`;
}

export function capitalised(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
