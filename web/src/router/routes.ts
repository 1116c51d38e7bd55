/** Which page an address names. Pure. */

export type Route =
  | { page: 'home' }
  | { page: 'experiments' }
  | { page: 'experiment'; experiment: string }
  | { page: 'editor'; experiment: string; copy: boolean }
  | { page: 'rigs' }
  | { page: 'rig'; rig: string }
  | { page: 'session'; rig: string }
  | { page: 'runs' }
  | { page: 'run'; run: number }
  | { page: 'people' }
  | { page: 'password' }
  | { page: 'missing' };

export function matchRoute(path: string): Route {
  const parts = path.split('/').filter((p) => p !== '').map(decode);
  const [first, second, third, ...rest] = parts;
  if (rest.length > 0) return { page: 'missing' };
  if (first === undefined) return { page: 'home' };
  if (second === undefined) {
    if (first === 'experiments' || first === 'rigs' || first === 'runs' || first === 'people' || first === 'password') return { page: first };
    return { page: 'missing' };
  }
  if (first === 'experiments' && third === undefined) return { page: 'experiment', experiment: second };
  if (first === 'experiments' && (third === 'edit' || third === 'copy')) return { page: 'editor', experiment: second, copy: third === 'copy' };
  if (first === 'rigs' && third === undefined) return { page: 'rig', rig: second };
  if (first === 'rigs' && third === 'session') return { page: 'session', rig: second };
  if (first === 'runs' && third === undefined && /^\d+$/.test(second)) return { page: 'run', run: Number(second) };
  return { page: 'missing' };
}

export const paths = {
  home: '/',
  experiments: '/experiments',
  experiment: (id: string) => `/experiments/${encodeURIComponent(id)}`,
  editExperiment: (id: string) => `/experiments/${encodeURIComponent(id)}/edit`,
  copyExperiment: (id: string) => `/experiments/${encodeURIComponent(id)}/copy`,
  rigs: '/rigs',
  bookFor: (rig: string, experiment: string) => `/rigs/${encodeURIComponent(rig)}?experiment=${encodeURIComponent(experiment)}`,
  rig: (id: string) => `/rigs/${encodeURIComponent(id)}`,
  session: (id: string) => `/rigs/${encodeURIComponent(id)}/session`,
  runs: '/runs',
  run: (id: number) => `/runs/${id}`,
  people: '/people',
  password: '/password',
};

function decode(part: string): string {
  try {
    return decodeURIComponent(part);
  } catch {
    return part;
  }
}
