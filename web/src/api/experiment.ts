/** The definition of an experiment, as in server/experiments/*.json, and who it belongs to. */
import { list, number, numberOrNull, record, text, texts, type Json } from './json';
import type { FieldError } from './types';

export interface Parameter {
  name: string;
  unit: string;
  min: number;
  max: number;
  step: number;
  /** null: it is not given unless somebody fills it in. */
  default: number | null;
  /** What a simulated rig has instead. */
  simulatedDefault: number | null;
  help: string;
  simulationOnly: boolean;
}

/** What is tracked; the settings of its method are left as they came. */
export interface TrackedObject {
  name: string;
  method: string;
  settings: Json;
}

export interface AcceptanceRule {
  fact: string;
  min: number | null;
  max: number | null;
  reason: string;
}

export type ExperimentState = 'built-in' | 'published' | 'draft' | 'retired';

export interface ExperimentDefinition {
  id: string;
  title: string;
  summary: string;
  theory: string;
  apparatus: string;
  parameters: Parameter[];
  objects: TrackedObject[];
  /** Whether something is drawn aside and held before it moves. */
  held: boolean;
  analysis: { method: string; objects: string[] };
  acceptance: AcceptanceRule[];
  state: ExperimentState;
  version: number | null;
  owner: string | null;
  mine: boolean;
  /** The definition alone, as the server wants it back from who changes it. */
  document: Json;
}

const states: ExperimentState[] = ['built-in', 'published', 'draft', 'retired'];

/** Tolerates more than it needs; throws where a parameter lacks what its field is built from. */
export function readDefinition(name: string, json: unknown): ExperimentDefinition {
  const { state, version, owner, mine, ...document } = record(json);
  const analysis = record(document['analysis']);
  return {
    id: text(document['id'], name),
    title: text(document['title'], name),
    summary: text(document['summary']),
    theory: text(document['theory']),
    apparatus: text(document['apparatus']),
    parameters: list(document['parameters']).map((entry) => readParameter(name, record(entry))),
    objects: list(document['objects']).map(readObject),
    held: list(document['sequence']).some((step) => record(step)['do'] === 'displace'),
    analysis: { method: text(analysis['method']), objects: texts(analysis['objects']) },
    acceptance: list(document['acceptance']).map(readRule),
    state: states.find((s) => s === state) ?? 'built-in',
    version: numberOrNull(version),
    owner: typeof owner === 'string' ? owner : null,
    mine: mine === true,
    document,
  };
}

/** What is wrong with a definition, its place as the definition itself has it; null if nothing is. */
export function readCheck(json: unknown): FieldError | null {
  const error = record(json)['error'];
  if (error === undefined || error === null) return null;
  const { field, message, cure } = record(error);
  return { field: text(field).replace(/^definition\.?/, ''), message: text(message, 'is wrong'), ...(text(cure) ? { cure: text(cure) } : {}) };
}

function readParameter(experiment: string, p: Json): Parameter {
  const parameter: Parameter = {
    name: text(p['name']),
    unit: text(p['unit']),
    min: number(p['min'], -Infinity),
    max: number(p['max'], Infinity),
    step: number(p['step']),
    default: numberOrNull(p['default']),
    simulatedDefault: numberOrNull(p['simulated_default']),
    help: text(p['help']),
    simulationOnly: p['simulation_only'] === true,
  };
  if (!parameter.name) throw new Error(`The definition of “${experiment}” has a parameter without a name.`);
  return parameter;
}

function readObject(value: unknown): TrackedObject {
  const { name, method, ...settings } = record(value);
  return { name: text(name), method: text(method), settings };
}

function readRule(value: unknown): AcceptanceRule {
  const rule = record(value);
  return { fact: text(rule['fact']), min: numberOrNull(rule['min']), max: numberOrNull(rule['max']), reason: text(rule['reason']) };
}
