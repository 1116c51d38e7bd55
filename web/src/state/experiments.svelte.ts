import * as lab from '../api/lab';
import type { ExperimentDefinition } from '../api/experiment';
import { humanise } from '../models/words';

/** What the experiments are called, asked for once: rigs, bookings and runs carry only their ids. */
let known = $state.raw<Record<string, ExperimentDefinition>>({});
let asked = false;

export function experimentTitle(id: string): string {
  return knownExperiment(id)?.title ?? humanise(id);
}

/** Null until the list is there, and of what is no longer in it. */
export function knownExperiment(id: string): ExperimentDefinition | null {
  if (!asked) {
    asked = true;
    lab.experiments().then(
      (list) => (known = Object.fromEntries(list.map((e) => [e.id, e]))),
      () => (asked = false),
    );
  }
  return known[id] ?? null;
}

/** Something was published, changed or retired: the next who asks gets what holds now. */
export function forgetExperiments(): void {
  asked = false;
}
