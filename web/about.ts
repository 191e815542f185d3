// What roverd is made of, for whoever uses it: the tables of the README as a module, and the licences of
// what is in the page as a file beside it, as those licences ask.

import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import type { Plugin } from 'vite';

import { packages_of } from './src/model/packages.ts';

const MODULE = 'virtual:about';

/** The folder of the package that a module belongs to; null: it is ours. */
const folder_of = (module: string): string | null => {
  const [file = ''] = module.replace(/^\0/, '').split('?');
  if (!file.includes('/node_modules/')) return null;
  let folder = dirname(file);
  while (folder.includes('/node_modules/')) {
    const about = join(folder, 'package.json');
    if (existsSync(about) && 'version' in (JSON.parse(readFileSync(about, 'utf8')) as object)) {
      return folder;
    }
    folder = dirname(folder);
  }
  return null;
};

const licence_of = (folder: string): string => {
  const about = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8')) as {
    name: string;
    version: string;
    license?: string;
  };
  const file = readdirSync(folder).find((name) => /^licen[cs]e/i.test(name));
  const text = file ? readFileSync(join(folder, file), 'utf8').trim() : '';
  return `${about.name} ${about.version} (${about.license ?? 'see below'})\n\n${text}\n`;
};

/** @param readme path of the README @param file name of the built list of licences */
export const about = (readme: string, file: string): Plugin => ({
  name: 'about',
  resolveId: (id) => (id === MODULE ? `\0${MODULE}` : null),
  load(id) {
    if (id !== `\0${MODULE}`) return null;
    this.addWatchFile(readme);
    return `export default ${JSON.stringify(packages_of(readFileSync(readme, 'utf8')))};`;
  },
  generateBundle() {
    const folders = new Set<string>();
    for (const id of this.getModuleIds()) {
      const folder = folder_of(id);
      if (folder) folders.add(folder);
    }
    const line = `\n${'-'.repeat(78)}\n\n`;
    const source = [...folders].map(licence_of).sort().join(line);
    this.emitFile({ type: 'asset', fileName: file, source });
  },
});
