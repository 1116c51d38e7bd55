import { svelte } from '@sveltejs/vite-plugin-svelte';
import { loadEnv } from 'vite';
import { defineConfig } from 'vitest/config';
import { precompress } from './precompress';

/** Where `npm run dev` finds the laboratory's server. */
const server = loadEnv('', '.', 'KINECTLAB_')['KINECTLAB_SERVER'] ?? 'http://localhost:8080';

export default defineConfig({
  plugins: [svelte(), precompress()],
  build: {
    target: 'es2022',
    // A data: address would need an exception in the content security policy.
    assetsInlineLimit: 0,
    // three.js is one piece of this size; it is loaded only where the rig is drawn.
    chunkSizeWarningLimit: 800,
  },
  server: { proxy: { '/api': { target: server, ws: true } } },
  // A loaded machine may take ten times as long; nothing here waits for a clock.
  test: { include: ['tests/**/*.test.ts'], environment: 'node', testTimeout: 120_000 },
});
