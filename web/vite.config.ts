import { svelte } from '@sveltejs/vite-plugin-svelte';
import { defineConfig } from 'vite';

import { about } from './about.ts';
import { early } from './early.ts';
import { offline } from './offline.ts';
import { precompress } from './precompress.ts';

/** Where `npm run dev` finds a running roverd. */
const server = process.env['ROVERD_URL'] ?? 'http://127.0.0.1:8080';

export default defineConfig({
  plugins: [
    svelte(),
    about('../README.md', 'licences.txt'),
    early('index.html', ['src/main.ts'], ['src/map/map.ts', 'src/ui/rest.ts']),
    offline('offline.js', 'index.html', 'docs.html'),
    precompress('dist'),
  ],
  build: {
    target: 'es2022',
    modulePreload: { polyfill: false },
    assetsInlineLimit: 0,
    rollupOptions: {
      // The interface's page is a second one: who drives never loads it. The service worker has a
      // name that stays, for browsers look for another one there.
      input: { index: 'index.html', docs: 'docs.html', offline: 'src/worker/offline.ts' },
      output: {
        entryFileNames: ({ name }) =>
          name === 'offline' ? 'offline.js' : 'assets/[name]-[hash].js',
      },
    },
  },
  server: {
    host: '127.0.0.1',
    proxy: { '/api': { target: server, ws: true }, '/tiles': server, '/docs': server },
  },
});
