// Tells the browser in the document itself which files come next, so that they are on their way before
// the one that asks for them has run; what can wait, behind what cannot.

import type { Plugin, Rollup } from 'vite';

interface File {
  readonly name: string;
  readonly waits: boolean;
}

const chunk_of = (module: string, bundle: Rollup.OutputBundle): Rollup.OutputChunk => {
  for (const one of Object.values(bundle)) {
    if (one.type === 'chunk' && one.facadeModuleId?.endsWith(`/${module}`)) return one;
  }
  throw new Error(`the build has no chunk for ${module}`);
};

/** A chunk, what it imports, and how they look. */
const files_of = (module: string, bundle: Rollup.OutputBundle): string[] => {
  const found = new Set<string>();
  const look = (chunk: Rollup.OutputChunk): void => {
    if (found.has(chunk.fileName)) return;
    found.add(chunk.fileName);
    for (const css of chunk.viteMetadata?.importedCss ?? []) found.add(css);
    for (const name of chunk.imports) {
      const one = bundle[name];
      if (one?.type === 'chunk') look(one);
    }
  };
  look(chunk_of(module, bundle));
  return [...found];
};

const link_to = ({ name, waits }: File) => ({
  tag: 'link',
  injectTo: 'head' as const, // behind how the document itself looks
  attrs: {
    ...(name.endsWith('.css') ? { rel: 'preload', as: 'style' } : { rel: 'modulepreload' }),
    crossorigin: true,
    ...(waits ? { fetchpriority: 'low' } : {}),
    href: `/${name}`,
  },
});

/** @param page the document @param next the modules that it cannot do without @param later that it can */
export const early = (page: string, next: readonly string[], later: readonly string[]): Plugin => ({
  name: 'early',
  apply: 'build',
  transformIndexHtml: {
    order: 'post',
    handler(html, { bundle, filename }) {
      if (!bundle || !filename.endsWith(`/${page}`)) return html;
      const named = (name: string): boolean => html.includes(`"/${name}"`);
      const first = new Set(next.flatMap((module) => files_of(module, bundle)));
      const rest = new Set(later.flatMap((module) => files_of(module, bundle)));
      const files: File[] = [
        ...[...first].map((name) => ({ name, waits: false })),
        ...[...rest].filter((name) => !first.has(name)).map((name) => ({ name, waits: true })),
      ];
      const tags = files.filter(({ name }) => !named(name)).map(link_to);
      return { html, tags };
    },
  },
});
