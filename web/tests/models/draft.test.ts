import { readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import { readCheck, readDefinition } from '../../src/api/experiment';
import type { Json } from '../../src/api/json';
import { copyOf, documentOf, draftOf, jsonProblem, partOf, placeInWords } from '../../src/models/draft';

const pendulum = JSON.parse(readFileSync(new URL('../../../server/experiments/pendulum.json', import.meta.url), 'utf8')) as Json;

describe('a definition as a form', () => {
  it('comes back as it was', () => {
    const { document, error } = documentOf(draftOf(pendulum));
    expect(error).toBeNull();
    // The form names what is measured, which a definition may leave to the server.
    expect(document).toEqual({ ...pendulum, analysis: { objects: [], ...(pendulum['analysis'] as Json) } });
  });

  it('keeps what a definition has of its own', () => {
    const definition = readDefinition('pendulum', { ...pendulum, state: 'draft', version: 2, owner: 'Ada', mine: true });
    expect(definition).toMatchObject({ state: 'draft', version: 2, owner: 'Ada', mine: true, held: true });
    expect(definition.document).toEqual(pendulum);
    expect(copyOf(pendulum)).toMatchObject({ id: 'pendulum_copy', title: 'Copy of Simple pendulum' });
  });

  it('leaves away what is not given', () => {
    const draft = draftOf(pendulum);
    draft.parameters[0]!.default = ' ';
    draft.settings['latitude_deg'] = { from: 'none', text: '' };
    draft.settings['length_u_m'] = { from: 'number', text: '0,001' };
    const { document, error } = documentOf(draft);
    expect(error).toBeNull();
    expect((document['parameters'] as Json[])[0]).not.toHaveProperty('default');
    const kept = { ...((pendulum['analysis'] as Json)['settings'] as Json), length_u_m: 0.001 };
    delete (kept as Json)['latitude_deg'];
    expect((document['analysis'] as Json)['settings']).toEqual(kept);
  });

  it('tells the first thing that is wrong, where the server would', () => {
    const draft = draftOf(pendulum);
    draft.json.sequence = '[\n  {"do": "stop"},\n  {"do" "wait"}\n]';
    expect(documentOf(draft).error).toMatchObject({ field: 'sequence', message: 'is no JSON: see line 3' });
    draft.parameters[1]!.max = 'much';
    expect(documentOf(draft).error).toMatchObject({ field: 'parameters[1].max', message: 'is “much”' });
    expect(jsonProblem(' ')).toBe('is empty');
    expect(jsonProblem('{"a": [1, 2')).toBe('is no JSON: see line 1');
  });
});

describe('places', () => {
  it('are told in words', () => {
    expect(placeInWords('parameters[2].unit')).toBe('Parameters, row 3, unit');
    expect(placeInWords('analysis.settings.length_m')).toBe('Analysis, settings, length_m');
    expect(placeInWords('theory')).toBe('Theory');
  });

  it('are found in the form', () => {
    expect(['parameters[2].unit', 'plots[0]', 'objects', 'elsewhere', ''].map(partOf)).toEqual(['parameters', 'analysis', 'objects', 'id', 'id']);
  });

  it('come without the request’s own member', () => {
    const check = (field: string) => readCheck({ ok: false, error: { field, message: 'is wrong', cure: '' } });
    expect(check('definition.theory')).toEqual({ field: 'theory', message: 'is wrong' });
    expect(check('definition')).toMatchObject({ field: '' });
    expect(readCheck({ ok: true })).toBeNull();
  });
});
