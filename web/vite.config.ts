import { svelte } from '@sveltejs/vite-plugin-svelte';
import { defineConfig } from 'vite';

import { precompress } from './precompress.ts';

/** Where `npm run dev` finds a running roverd. */
const server = process.env['ROVERD_URL'] ?? 'http://127.0.0.1:8080';

export default defineConfig({
  plugins: [svelte(), precompress('dist')],
  build: {
    target: 'es2022',
    modulePreload: { polyfill: false },
    assetsInlineLimit: 0,
    // The interface's page is a second one: who drives never loads it.
    rollupOptions: { input: ['index.html', 'docs.html'] },
  },
  server: {
    host: '127.0.0.1',
    proxy: { '/api': { target: server, ws: true }, '/tiles': server, '/docs': server },
  },
});
