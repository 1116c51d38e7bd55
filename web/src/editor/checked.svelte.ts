import * as lab from '../api/lab';
import type { FieldError } from '../api/types';
import { documentOf, type Draft } from '../models/draft';
import { asApiError } from '../state/resource.svelte';

const pause = 500;

/** The draft as a definition, and what the server says to it, a moment after the last key. */
export class Checked {
  private readonly draft: () => Draft;
  readonly written = $derived.by(() => documentOf(this.draft()));
  private answer = $state.raw<FieldError | null>(null);
  checking = $state(true);
  unchecked = $state<string | null>(null);
  readonly error = $derived(this.written.error ?? this.answer);
  readonly sound = $derived(!this.error && !this.checking && !this.unchecked);

  constructor(draft: () => Draft) {
    this.draft = draft;
  }

  /** To be called in an effect: asks again whenever the draft changed; returns how to call it off. */
  watch(): () => void {
    const { document, error } = this.written;
    let outdated = false;
    if (error) {
      this.checking = false;
      return () => {};
    }
    this.checking = true;
    const timer = setTimeout(async () => {
      try {
        const answer = await lab.checkExperiment(document);
        if (outdated) return;
        this.answer = answer;
        this.unchecked = null;
      } catch (e) {
        if (outdated) return;
        this.answer = null;
        this.unchecked = asApiError(e).message;
      }
      this.checking = false;
    }, pause);
    return () => {
      outdated = true;
      clearTimeout(timer);
    };
  }
}
