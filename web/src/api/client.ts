import { offlineError, problemToError } from './problem';

export const base = '/api/v1';

let csrfToken = '';
let whenSignedOut: () => void = () => {};

/** The token that goes with every change; it comes with the session. */
export function useCsrfToken(token: string): void {
  csrfToken = token;
}

/** Called when the server no longer knows who we are. */
export function onSignedOut(handler: () => void): void {
  whenSignedOut = handler;
}

type Method = 'GET' | 'POST' | 'PUT' | 'DELETE';

/** One request. Resolves with the body (undefined for 204), throws ApiError otherwise. */
export async function request<T>(method: Method, path: string, body?: unknown): Promise<T> {
  const headers: Record<string, string> = { Accept: 'application/json' };
  if (method !== 'GET') headers['X-CSRF-Token'] = csrfToken;
  if (body !== undefined) headers['Content-Type'] = 'application/json';

  let response: Response;
  try {
    response = await fetch(base + path, {
      method,
      headers,
      credentials: 'same-origin',
      ...(body === undefined ? {} : { body: JSON.stringify(body) }),
    });
  } catch {
    throw offlineError();
  }
  if (response.ok) return (response.status === 204 ? undefined : await readJson(response)) as T;
  const error = problemToError(response.status, await readJson(response).catch(() => null));
  if (response.status === 401 && path !== '/session') whenSignedOut();
  throw error;
}

async function readJson(response: Response): Promise<unknown> {
  const text = await response.text();
  return text === '' ? undefined : JSON.parse(text);
}

/** `{a: 1, b: undefined}` → `?a=1` */
export function query(values: Record<string, string | number | boolean | undefined>): string {
  const search = new URLSearchParams();
  for (const [key, value] of Object.entries(values)) {
    if (value !== undefined) search.set(key, String(value));
  }
  const text = search.toString();
  return text ? `?${text}` : '';
}
