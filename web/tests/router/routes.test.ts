import { expect, it } from 'vitest';
import { matchRoute, paths } from '../../src/router/routes';

it('knows its own addresses', () => {
  expect(matchRoute(paths.home)).toEqual({ page: 'home' });
  expect(matchRoute(paths.rig('a b/c'))).toEqual({ page: 'rig', rig: 'a b/c' });
  expect(matchRoute(paths.session('rig-1'))).toEqual({ page: 'session', rig: 'rig-1' });
  expect(matchRoute(paths.run(12))).toEqual({ page: 'run', run: 12 });
  expect(matchRoute(paths.experiment('spring'))).toEqual({ page: 'experiment', experiment: 'spring' });
  expect(matchRoute(paths.copyExperiment('spring'))).toEqual({ page: 'editor', experiment: 'spring', copy: true });
  expect(matchRoute(paths.editExperiment('spring'))).toEqual({ page: 'editor', experiment: 'spring', copy: false });
  expect(matchRoute('/runs/')).toEqual({ page: 'runs' });
});

it.each(['/nowhere', '/runs/twelve', '/runs/1/2', '/rigs/a/b', '/rigs/a/session/x', '/people/1', '/rigs/%E0%A4%A/x'])('has no page at %s', (path) => {
  expect(matchRoute(path)).toEqual({ page: 'missing' });
});
