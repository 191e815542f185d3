import { defineConfig } from 'vitest/config';

// The model needs neither a browser nor Svelte: plain Node runs its tests.
export default defineConfig({ test: { include: ['tests/**/*.test.ts'], environment: 'node' } });
