import { defineConfig } from 'vitest/config';

// The model needs neither a browser nor Svelte: plain Node runs its tests. It keeps no state of its own,
// so one process runs them all: to start one for each file takes longer than the tests.
export default defineConfig({
  test: {
    execArgv: ['--expose-gc'], // what grows is seen only without what is garbage
    include: ['tests/**/*.test.ts'],
    environment: 'node',
    isolate: false,
    maxWorkers: 1,
  },
});
