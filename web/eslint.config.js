import js from '@eslint/js';
import svelte from 'eslint-plugin-svelte';
import globals from 'globals';
import ts from 'typescript-eslint';

import svelte_config from './svelte.config.js';

export default ts.config(
  { ignores: ['dist', 'src/link/schema.d.ts'] },
  js.configs.recommended,
  ...ts.configs.strict,
  ...svelte.configs.recommended,
  { languageOptions: { globals: globals.browser } },
  {
    rules: {
      eqeqeq: 'error',
      'no-console': 'error',
      'prefer-const': 'error',
      'max-lines': ['error', 400],
      'max-params': ['error', 5],
    },
  },
  {
    files: ['**/*.svelte', '**/*.svelte.ts'],
    languageOptions: {
      parserOptions: {
        parser: ts.parser,
        extraFileExtensions: ['.svelte'],
        svelteConfig: svelte_config,
      },
    },
  },
  {
    files: ['**/*.svelte'],
    rules: {
      // `let { x } = $props()` is how Svelte writes properties that change from outside.
      'prefer-const': 'off',
      'svelte/prefer-const': ['error', { excludedRunes: ['$props', '$derived'] }],
    },
  },
  // Sets here are values: made once, never changed, so nothing has to watch them.
  { files: ['src/ui/**'], rules: { 'svelte/prefer-svelte-reactivity': 'off' } },
  { files: ['*.ts', '*.js'], languageOptions: { globals: globals.node } },
  { files: ['src/**/*.ts'], rules: { 'max-lines-per-function': ['error', 60] } },
);
