// What a person reads stands in src/texts, and not in the panels. A panel that still says something in its
// own words is listed here with what it says; the list only ever gets shorter.

import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { parse, type AST } from 'svelte/compiler';
import { expect, test } from 'vitest';

const UI = join(import.meta.dirname, '../src/ui');
const READ = new Set(['aria-label', 'title', 'placeholder', 'alt', 'label', 'one', 'back', 'does']);

/** To read all of them takes a second, on a machine that does something else as well, longer. */
const LONGEST_MS = 60_000;
/** The same in every language: names of things, units, keys, what stands on the stop button. */
const ANYWHERE = new Set([
  'roverd',
  'STOP',
  'Authorization: Bearer …',
  '.yaml',
  '.pcd',
  '.pgm',
  'UTM',
  'OK',
  'rms',
]);
const STILL: Readonly<Record<string, readonly string[]>> = {};

type Node = Readonly<Record<string, unknown>> & { readonly type?: string };
const is_words = (text: string): boolean => /\p{L}{3}|\p{L}{2}\s\p{L}/u.test(text);

/** Of a program's own: it begins like a sentence, and has a second word. */
const is_sentence = (text: string): boolean => /^[“\s]*\p{Lu}\p{Ll}*\s\p{L}/u.test(text);

/** Texts between tags, those of attributes that are read, and sentences in what is worked out. */
const words_in = (node: unknown, found: string[] = []): string[] => {
  if (Array.isArray(node)) {
    for (const each of node) words_in(each, found);
  } else if (typeof node === 'object' && node !== null) {
    const { type, ...rest } = node as Node;
    if (type === 'Attribute' && !READ.has(String(rest['name']))) return found;
    if (type === 'StyleDirective' || type === 'ImportDeclaration') return found;
    const { data, value } = rest;
    const text = type === 'Text' ? String(data).trim() : '';
    if (type === 'Literal' && typeof value === 'string' && is_sentence(value)) found.push(value);
    if (is_words(text) && !ANYWHERE.has(text)) found.push(text.replace(/\s+/g, ' '));
    for (const [name, part] of Object.entries(rest)) {
      if (name !== 'metadata' && name !== 'parent') words_in(part, found);
    }
  }
  return found;
};

test(
  'panels say nothing in words of their own, but what is listed',
  () => {
    const still: Record<string, string[]> = {};
    const panels = readdirSync(UI).filter((name) => name.endsWith('.svelte'));
    for (const name of panels) {
      const tree: AST.Root = parse(readFileSync(join(UI, name), 'utf8'), { modern: true });
      const words = words_in([tree.fragment, tree.instance, tree.module]);
      if (words.length > 0) still[name] = words;
    }
    expect(panels.length).toBeGreaterThan(50);
    expect(still).toEqual(STILL);
  },
  LONGEST_MS,
);
