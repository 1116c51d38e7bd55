import { ApiError } from '../api/problem';

/** Something that is fetched: loading, there, or failed. What was there stays while it is fetched anew. */
export class Resource<T> {
  data = $state.raw<T | null>(null);
  error = $state.raw<ApiError | null>(null);
  loading = $state(false);
  private latest = 0;
  private readonly fetcher: () => Promise<T>;

  constructor(fetcher: () => Promise<T>) {
    this.fetcher = fetcher;
  }

  /** Of several at once only the last one counts. */
  async load(): Promise<void> {
    const ticket = ++this.latest;
    this.loading = true;
    try {
      const data = await this.fetcher();
      if (ticket !== this.latest) return;
      this.data = data;
      this.error = null;
    } catch (error) {
      if (ticket !== this.latest) return;
      this.error = asApiError(error);
    } finally {
      if (ticket === this.latest) this.loading = false;
    }
  }
}

/** Loads now, then every `interval` ms while the page is looked at; returns how to end it. */
export function poll(resource: Resource<unknown>, interval: number): () => void {
  void resource.load();
  const timer = setInterval(() => {
    if (!document.hidden) void resource.load();
  }, interval);
  return () => clearInterval(timer);
}

export function asApiError(error: unknown): ApiError {
  return error instanceof ApiError ? error : new ApiError(-1, error instanceof Error ? error.message : String(error));
}
