/** The time, for what is shown in words: moves once a second while somebody looks. */
class Clock {
  now = $state(Date.now());

  constructor() {
    setInterval(() => (this.now = Date.now()), 1000);
    // A page that comes back to the front must not show an old time for up to a second.
    document.addEventListener('visibilitychange', () => (this.now = Date.now()));
  }
}

export const clock = new Clock();
