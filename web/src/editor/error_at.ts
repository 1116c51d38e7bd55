import type { FieldError } from '../api/types';

/** What to show at a field: the check tells one place at a time. */
export function errorAt(error: FieldError | null, field: string): string | null {
  if (error?.field !== field) return null;
  return error.cure ? `${error.message}; ${error.cure}` : error.message;
}

/** Whether the place lies in this part: `parameters[2].unit` in `parameters[2]`. */
export function errorWithin(error: FieldError | null, part: string): boolean {
  return error !== null && (error.field === part || error.field.startsWith(`${part}.`) || error.field.startsWith(`${part}[`));
}
