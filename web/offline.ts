// Tells the service worker what the page is made of: files whose names carry their content, so that
// another build is another worker, and the browser notices.

import { createHash } from 'node:crypto';
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Plugin, Rollup } from 'vite';

const ALWAYS = ['/icon.svg', '/roverd.webmanifest'];

/** Everything that one chunk may come to need, itself included. */
const needed_by = (entry: Rollup.OutputChunk, bundle: Rollup.OutputBundle): Set<string> => {
  const found = new Set<string>();
  const look = (name: string): void => {
    if (found.has(name)) return;
    found.add(name);
    const chunk = bundle[name];
    if (chunk?.type !== 'chunk') return;
    const { importedCss, importedAssets } = chunk.viteMetadata ?? {};
    [
      ...chunk.imports,
      ...chunk.dynamicImports,
      ...(importedCss ?? []),
      ...(importedAssets ?? []),
    ].forEach(look);
  };
  look(entry.fileName);
  return found;
};

const entry_of = (page: string, bundle: Rollup.OutputBundle): Rollup.OutputChunk => {
  for (const one of Object.values(bundle)) {
    if (one.type === 'chunk' && one.isEntry && one.facadeModuleId?.endsWith(`/${page}`)) return one;
  }
  throw new Error(`the build has no ${page}`);
};

/** @param worker file name of the built worker
 * @param page the page that it keeps; what is there only for `other` is left out */
export const offline = (worker: string, page: string, other: string): Plugin => ({
  name: 'offline',
  apply: 'build',
  writeBundle({ dir = 'dist' }, bundle) {
    const needed = needed_by(entry_of(page, bundle), bundle);
    const foreign = needed_by(entry_of(other, bundle), bundle);
    // What is on the disk: the bundle lists pieces that the build has taken out again.
    const parts = readdirSync(join(dir, 'assets'))
      .map((name) => `assets/${name}`)
      .filter((name) => (needed.has(name) || !foreign.has(name)) && !/\.(br|gz)$/.test(name))
      .map((name) => `/${name}`)
      .concat(ALWAYS);
    const version = createHash('sha256')
      .update(readFileSync(join(dir, page)))
      .update(parts.join())
      .digest('hex')
      .slice(0, 12);
    const path = join(dir, worker);
    const told = `self.page=${JSON.stringify({ version, parts })};\n`;
    writeFileSync(path, told + readFileSync(path, 'utf8'));
  },
});
