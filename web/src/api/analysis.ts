/** What an analysis can be told, and what it told of a run. */
import { list, number, numberOrNull, record, text, texts } from './json';
import type { Column, Result } from './types';

export interface AnalysisSetting {
  name: string;
  min: number;
  max: number;
  /** What holds where it is not given; null: it is then estimated, or its effect is a line in the budget. */
  otherwise: number | null;
  required: boolean;
  help: string;
}

export interface AnalysisMethod {
  name: string;
  objects: number;
  settings: AnalysisSetting[];
  results: string[];
  plots: string[];
  facts: string[];
}

export interface PlotSeries {
  name: string;
  mark: 'line' | 'points';
  x: Column;
  y: Column;
  /** Standard uncertainty of y; empty: none is drawn. */
  u: Column;
}

export interface Plot {
  name: string;
  title: string;
  xLabel: string;
  yLabel: string;
  equalAxes: boolean;
  series: PlotSeries[];
}

export interface ResultVersion {
  version: number;
  created: string;
  person: string | null;
  result: Result;
}

export function readMethods(json: unknown): AnalysisMethod[] {
  return list(record(json)['analyses']).map((value) => {
    const m = record(value);
    return {
      name: text(m['name']), objects: number(m['objects'], 1), settings: list(m['settings']).map(readSetting),
      results: texts(m['results']), plots: texts(m['plots']), facts: texts(m['facts']),
    };
  });
}

function readSetting(value: unknown): AnalysisSetting {
  const s = record(value);
  return {
    name: text(s['name']), min: number(s['min'], -Infinity), max: number(s['max'], Infinity), otherwise: numberOrNull(s['otherwise']),
    required: s['required'] === true, help: text(s['help']),
  };
}

/** Columns of unequal length are cut to the shortest: what has no partner cannot be drawn. */
export function readPlots(json: unknown): Plot[] {
  return list(record(json)['plots']).map((value) => {
    const p = record(value);
    return {
      name: text(p['name']), title: text(p['title'], text(p['name'])), xLabel: text(p['x_label']), yLabel: text(p['y_label']),
      equalAxes: p['equal_axes'] === true, series: list(p['series']).map(readSeries),
    };
  });
}

function readSeries(value: unknown): PlotSeries {
  const s = record(value);
  const x = column(s['x']);
  const y = column(s['y']);
  const n = Math.min(x.length, y.length);
  return { name: text(s['name']), mark: s['mark'] === 'points' ? 'points' : 'line', x: x.slice(0, n), y: y.slice(0, n), u: column(s['u']).slice(0, n) };
}

function column(value: unknown): Column {
  return list(value).map(numberOrNull);
}

/** Newest last. */
export function readVersions(json: unknown): ResultVersion[] {
  const versions = list(record(json)['results']).map((value): ResultVersion => {
    const v = record(value);
    return {
      version: number(v['version'], 0), created: text(v['created']), person: typeof v['person'] === 'string' ? v['person'] : null,
      result: v['result'] as Result,
    };
  });
  return versions.filter((v) => Array.isArray(v.result?.results)).sort((a, b) => a.version - b.version);
}
