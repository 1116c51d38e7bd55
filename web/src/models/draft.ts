/** A definition as a form, and the form as a definition. Pure. What is hard to lay out as fields stays JSON text. */
import { list, record, text, texts, type Json } from '../api/json';
import type { FieldError } from '../api/types';
import { parseDecimal } from './number';

export interface ParameterRow {
  name: string;
  unit: string;
  min: string;
  max: string;
  step: string;
  /** Empty: not given unless somebody fills it in. */
  default: string;
  /** Named as in the definition. Empty: a simulated rig has the default too. */
  simulated_default: string;
  help: string;
  simulationOnly: boolean;
}

export interface RuleRow {
  fact: string;
  min: string;
  max: string;
  reason: string;
}

/** Where a setting of the analysis comes from: `none`, `number`, `json`, or `parameter:NAME`. */
export interface SourceRow {
  from: string;
  text: string;
}

export const jsonParts = ['objects', 'sequence', 'preprocess', 'early_end'] as const;
export type JsonPart = (typeof jsonParts)[number];
const optionalParts: readonly JsonPart[] = ['preprocess', 'early_end'];

export interface Draft {
  id: string;
  title: string;
  summary: string;
  theory: string;
  apparatus: string;
  parameters: ParameterRow[];
  duration: SourceRow;
  method: string;
  /** Names, separated by commas, in the order in which the method takes them. */
  objects: string;
  settings: Record<string, SourceRow>;
  plots: string[];
  acceptance: RuleRow[];
  json: Record<JsonPart, string>;
}

export function draftOf(document: Json): Draft {
  const analysis = record(document['analysis']);
  const part = (name: JsonPart) => (document[name] === undefined ? '' : laidOut(document[name]));
  return {
    id: text(document['id']),
    title: text(document['title']),
    summary: text(document['summary']),
    theory: text(document['theory']),
    apparatus: text(document['apparatus']),
    parameters: list(document['parameters']).map((value) => {
      const p = record(value);
      return {
        name: text(p['name']), unit: text(p['unit']), min: numeral(p['min']), max: numeral(p['max']), step: numeral(p['step']),
        default: numeral(p['default']), simulated_default: numeral(p['simulated_default']), help: text(p['help']), simulationOnly: p['simulation_only'] === true,
      };
    }),
    duration: sourceOf(document['duration_s']),
    method: text(analysis['method']),
    objects: texts(analysis['objects']).join(', '),
    settings: Object.fromEntries(Object.entries(record(analysis['settings'])).map(([name, value]) => [name, sourceOf(value)])),
    plots: texts(document['plots']),
    acceptance: list(document['acceptance']).map((value) => {
      const rule = record(value);
      return { fact: text(rule['fact']), min: numeral(rule['min']), max: numeral(rule['max']), reason: text(rule['reason']) };
    }),
    json: { objects: part('objects'), sequence: part('sequence'), preprocess: part('preprocess'), early_end: part('early_end') },
  };
}

/** A copy stands beside what it was made from. */
export function copyOf(document: Json): Json {
  return { ...document, id: `${text(document['id'])}_copy`, title: `Copy of ${text(document['title'])}` };
}

export interface Written {
  document: Json;
  /** What keeps it from being one: told before the server is asked. Fields as the server names them. */
  error: FieldError | null;
}

export function documentOf(draft: Draft): Written {
  const writer = new Writer();
  const document: Json = {
    id: draft.id.trim(),
    title: draft.title.trim(),
    summary: draft.summary.trim(),
    theory: draft.theory,
    apparatus: draft.apparatus.trim(),
    parameters: draft.parameters.map((p, i) => {
      const at = `parameters[${i}]`;
      return {
        name: p.name.trim(), unit: p.unit.trim(), min: writer.number(`${at}.min`, p.min), max: writer.number(`${at}.max`, p.max),
        step: writer.number(`${at}.step`, p.step), ...(p.default.trim() ? { default: writer.number(`${at}.default`, p.default) } : {}),
        ...(p.simulated_default.trim() ? { simulated_default: writer.number(`${at}.simulated_default`, p.simulated_default) } : {}),
        help: p.help.trim(), simulation_only: p.simulationOnly,
      };
    }),
    duration_s: writer.source('duration_s', draft.duration),
    analysis: {
      method: draft.method,
      objects: draft.objects.split(',').map((name) => name.trim()).filter(Boolean),
      settings: Object.fromEntries(
        Object.entries(draft.settings)
          .filter(([, source]) => source.from !== 'none')
          .map(([name, source]) => [name, writer.source(`analysis.settings.${name}`, source)]),
      ),
    },
    plots: draft.plots,
    acceptance: draft.acceptance.map((rule, i) => ({
      fact: rule.fact,
      ...(rule.min.trim() ? { min: writer.number(`acceptance[${i}].min`, rule.min) } : {}),
      ...(rule.max.trim() ? { max: writer.number(`acceptance[${i}].max`, rule.max) } : {}),
      reason: rule.reason.trim(),
    })),
  };
  for (const part of jsonParts) {
    if (draft.json[part].trim() || !optionalParts.includes(part)) document[part] = writer.json(part, draft.json[part]);
  }
  return { document, error: writer.error };
}

/** Keeps the first of what is wrong: the server tells one thing at a time too. */
class Writer {
  error: FieldError | null = null;

  number(field: string, typed: string): number | null {
    const value = parseDecimal(typed);
    if (!Number.isNaN(value)) return value;
    this.refuse(field, typed.trim() ? `is “${typed.trim()}”` : 'is empty', 'give a number');
    return null;
  }

  source(field: string, { from, text: typed }: SourceRow): unknown {
    if (from.startsWith('parameter:')) return { parameter: from.slice('parameter:'.length) };
    return from === 'json' ? this.json(field, typed) : this.number(field, typed);
  }

  json(field: string, typed: string): unknown {
    const wrong = jsonProblem(typed);
    if (wrong === null) return JSON.parse(typed);
    this.refuse(field, wrong, 'write JSON as the examples do');
    return null;
  }

  private refuse(field: string, message: string, cure: string): void {
    this.error ??= { field, message, cure };
  }
}

/** Why a text is no JSON, with the line; null if it is. */
export function jsonProblem(typed: string): string | null {
  if (typed.trim() === '') return 'is empty';
  try {
    JSON.parse(typed);
    return null;
  } catch (e) {
    const message = e instanceof Error ? e.message : String(e);
    const position = /position (\d+)/.exec(message)?.[1];
    const told = /line (\d+)/.exec(message)?.[1];
    // Without a place it is the end that is missing.
    const line = told ?? String((position === undefined ? typed : typed.slice(0, Number(position))).split('\n').length);
    return `is no JSON: see line ${line}`;
  }
}

/** A list with each of its elements on a line, as one writes it by hand. */
function laidOut(value: unknown): string {
  const flat = (v: unknown) => JSON.stringify(v, null, 1).replace(/\n\s*/g, ' ').replace(/^([[{]) /, '$1').replace(/ ([\]}])$/, '$1');
  return Array.isArray(value) && value.length > 0 ? `[\n${value.map((v) => `  ${flat(v)}`).join(',\n')}\n]` : JSON.stringify(value, null, 2);
}

function sourceOf(value: unknown): SourceRow {
  if (typeof value === 'number') return { from: 'number', text: String(value) };
  const parameter = record(value)['parameter'];
  if (typeof parameter === 'string') return { from: `parameter:${parameter}`, text: '' };
  return value === undefined ? { from: 'none', text: '' } : { from: 'json', text: JSON.stringify(value) };
}

function numeral(value: unknown): string {
  return typeof value === 'number' ? String(value) : '';
}

const placeNames: Record<string, string> = {
  id: 'Short name', title: 'Title', summary: 'Summary', theory: 'Theory', apparatus: 'Apparatus', parameters: 'Parameters', objects: 'Objects',
  preprocess: 'Preprocessing', sequence: 'Sequence', duration_s: 'Duration', early_end: 'Early end', analysis: 'Analysis', plots: 'Plots',
  acceptance: 'What a good run looks like',
};

/** `parameters[2].unit` → `Parameters, row 3, unit` */
export function placeInWords(field: string): string {
  const [first = '', ...rest] = field.replace(/\[(\d+)\]/g, (_, i: string) => `.row ${Number(i) + 1}`).split('.');
  return [placeNames[first] ?? first, ...rest].filter(Boolean).join(', ');
}

/** The part of the form in which a place lies: `parameters[2].unit` → `parameters`. */
export function partOf(field: string): string {
  const part = /^[a-z_]+/.exec(field)?.[0] ?? '';
  if (part === 'plots') return 'analysis';
  return part in placeNames ? part : 'id';
}
