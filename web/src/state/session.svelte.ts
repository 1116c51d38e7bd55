import { onSignedOut, useCsrfToken } from '../api/client';
import * as lab from '../api/lab';
import { ApiError } from '../api/problem';
import type { Role, Session, User } from '../api/types';
import { asApiError } from './resource.svelte';

const ranks: Role[] = ['student', 'assistant', 'instructor', 'staff', 'admin'];

/** Who is signed in. `unknown` until the server has been asked. */
class SessionState {
  status = $state<'unknown' | 'signed-out' | 'signed-in'>('unknown');
  user = $state.raw<User | null>(null);
  failure = $state.raw<ApiError | null>(null);

  constructor() {
    onSignedOut(() => this.forget());
  }

  async restore(): Promise<void> {
    this.failure = null;
    try {
      this.adopt(await lab.currentSession());
    } catch (error) {
      const failure = asApiError(error);
      if (failure.status === 401) this.forget();
      else this.failure = failure;
    }
  }

  async signIn(username: string, password: string): Promise<void> {
    this.adopt(await lab.signIn(username, password));
  }

  async changePassword(current: string, next: string): Promise<void> {
    this.adopt(await lab.changePassword(current, next));
  }

  async signOut(): Promise<void> {
    await lab.signOut();
    this.forget();
  }

  atLeast(role: Role): boolean {
    return this.user !== null && ranks.indexOf(this.user.role) >= ranks.indexOf(role);
  }

  private adopt(session: Session): void {
    useCsrfToken(session.csrf_token);
    this.user = session.user;
    this.status = 'signed-in';
  }

  private forget(): void {
    useCsrfToken('');
    this.user = null;
    this.status = 'signed-out';
  }
}

export const session = new SessionState();
