/** The definition of an experiment, as in server/experiments/*.json: what a person may set before a run. */

export interface Parameter {
  name: string;
  unit: string;
  min: number;
  max: number;
  step: number;
  default: number;
  help: string;
  simulationOnly: boolean;
}

export interface ExperimentDefinition {
  id: string;
  title: string;
  summary: string;
  parameters: Parameter[];
}

/** Tolerates more than it needs; throws where a parameter lacks what its field is built from. */
export function readDefinition(name: string, json: unknown): ExperimentDefinition {
  const d = record(json);
  const list = Array.isArray(d['parameters']) ? d['parameters'] : [];
  return {
    id: text(d['id'], name),
    title: text(d['title'], name),
    summary: text(d['summary'], ''),
    parameters: list.map((entry) => readParameter(name, record(entry))),
  };
}

function readParameter(experiment: string, p: Record<string, unknown>): Parameter {
  const parameter: Parameter = {
    name: text(p['name'], ''),
    unit: text(p['unit'], ''),
    min: number(p['min'], -Infinity),
    max: number(p['max'], Infinity),
    step: number(p['step'], NaN),
    default: number(p['default'], NaN),
    help: text(p['help'], ''),
    simulationOnly: p['simulation_only'] === true,
  };
  if (!parameter.name || !Number.isFinite(parameter.default)) {
    throw new Error(`The definition of “${experiment}” has a parameter without a name or a default.`);
  }
  return parameter;
}

function record(value: unknown): Record<string, unknown> {
  return typeof value === 'object' && value !== null ? (value as Record<string, unknown>) : {};
}

function text(value: unknown, otherwise: string): string {
  return typeof value === 'string' ? value : otherwise;
}

function number(value: unknown, otherwise: number): number {
  return typeof value === 'number' ? value : otherwise;
}
