/** Names of the wire end with their unit, `length_m`: the same endings as in server/experiments/units_of_names.cpp. */

/** Longer ones before those that they end with. */
const endings: [string, string][] = [
  ['_kg_m3', 'kg/m³'], ['_m_s2', 'm/s²'], ['_deg_s', '°/s'], ['_m_s', 'm/s'], ['_n_m', 'N/m'], ['_per_rad', '1/rad'], ['_per_s', '1/s'],
  ['_per_m', '1/m'], ['_rad_s', 'rad/s'], ['_deg', '°'], ['_rad', 'rad'], ['_hz', 'Hz'], ['_kg', 'kg'], ['_mm', 'mm'], ['_cm', 'cm'],
  ['_min', 'min'], ['_m', 'm'], ['_s', 's'],
];

export interface SplitName {
  /** Without its unit: `length_u` of `length_u_m`. */
  stem: string;
  /** For people; empty where the name tells none. */
  unit: string;
}

export function splitName(name: string): SplitName {
  const ending = endings.find(([end]) => name.length > end.length && name.endsWith(end));
  return ending ? { stem: name.slice(0, -ending[0].length), unit: ending[1] } : { stem: name, unit: '' };
}
