/** Names of the wire as a student would say them. */
import type { Rig } from '../api/types';

const parameterLabels: Record<string, string> = {
  length_m: 'Length of the pendulum',
  length_u_m: 'Uncertainty of the length',
  bob_radius_m: 'Radius of the bob',
  amplitude_deg: 'Starting angle',
  gravity: 'Gravity',
  damping_per_s: 'Damping',
  latitude_deg: 'Latitude',
  duration_s: 'How long to measure',
};

const parameterUnits: Record<string, string> = {
  length_m: 'm', length_u_m: 'm', bob_radius_m: 'm', amplitude_deg: '°', gravity: 'm/s²',
  latitude_deg: '°', damping_per_s: '1/s', duration_s: 's',
};

const quantityLabels: Record<string, string> = {
  g: 'Acceleration of free fall g',
  period: 'Period as it swung',
  small_angle_period: 'Period at a small angle',
  amplitude: 'Angle at the start',
  damping: 'Damping',
  quality_factor: 'Quality factor',
  turning_rate: 'Turning of the swing plane',
  quadratic_damping: 'Quadratic damping',
  precession_rate: 'Turning of the swing plane',
  latitude: 'Latitude',
  ellipse_a: 'Half the length of the ellipse',
  ellipse_b: 'Half the width of the ellipse',
  airy_rate: 'Turning of the ellipse by itself',
};

const sourceLabels: Record<string, string> = {
  statistics: 'Scatter of the measured points',
  length: 'Length of the pendulum',
  clock: 'Clock of the camera',
  'depth scale': 'Depth scale of the camera',
  'camera tilt': 'Level of the camera',
  'model choice': 'Choice of the drag law',
  'bob size': 'Unknown size of the bob',
  air: 'Unknown effect of the air',
  string: 'Unknown mass of the string',
};

/** As a student meets them: the pendulum first, then how it is measured; unknown ones last. */
export function inReadingOrder(parameters: Record<string, number>): [string, number][] {
  const order = Object.keys(parameterLabels);
  const place = (name: string) => (order.includes(name) ? order.indexOf(name) : order.length);
  return Object.entries(parameters).sort(([a], [b]) => place(a) - place(b));
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
export const parameterLabel = (name: string): string => parameterLabels[name] ?? humanise(name);
export const parameterUnit = (name: string): string => parameterUnits[name] ?? '';
export const quantityLabel = (name: string): string => quantityLabels[name] ?? humanise(name);
export const sourceLabel = (name: string): string => sourceLabels[name] ?? humanise(name);
export const experimentTitle = (name: string): string => (name === 'pendulum' ? 'Foucault pendulum' : humanise(name));

/** A sentence of the server's without names of the wire: `is length_m right?` → `is the length of the pendulum right?` */
export function inWords(text: string): string {
  return text.replace(/\b(?:parameters\.)?([a-z]+(?:_[a-z]+)+)\b/g, (whole, name: string) => {
    const label = parameterLabels[name];
    return label ? withArticle(label) : whole;
  });
}

function withArticle(label: string): string {
  const words = label.charAt(0).toLowerCase() + label.slice(1);
  return words.startsWith('how ') || words === 'damping' ? words : `the ${words}`;
}

/** `string_mass_kg` → `String mass kg` */
export function humanise(name: string): string {
  const words = name.replaceAll('_', ' ').trim();
  return words.charAt(0).toUpperCase() + words.slice(1);
}
