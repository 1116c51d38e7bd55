import { matchRoute } from './routes';

/** The address bar as state. Plain links work: clicks on them are answered here. */
class Router {
  path = $state(location.pathname);
  route = $derived(matchRoute(this.path));

  constructor() {
    addEventListener('popstate', () => this.show());
    document.addEventListener('click', (event) => this.follow(event));
  }

  go(path: string, how: 'push' | 'replace' = 'push'): void {
    if (how === 'push') history.pushState(null, '', path);
    else history.replaceState(null, '', path);
    this.show();
    scrollTo(0, 0);
  }

  private show(): void {
    this.path = location.pathname;
  }

  private follow(event: MouseEvent): void {
    if (event.defaultPrevented || event.button !== 0 || event.metaKey || event.ctrlKey || event.shiftKey || event.altKey) return;
    const link = (event.target as Element | null)?.closest('a');
    if (!link || link.origin !== location.origin || link.hasAttribute('download') || link.target) return;
    if (link.pathname.startsWith('/api/')) return;
    // A link within the page (the skip link) is the browser's.
    if (link.hash && link.pathname === location.pathname) return;
    event.preventDefault();
    this.go(link.pathname + link.search);
  }
}

export const router = new Router();
