// What the robot says in English, in the language of the page. It has stable words for kinds of events and
// conditions, but says why in sentences, with figures in them; those that people meet in the field are in
// the texts (texts/en/robot.ts), and are known by how they read in English. Some of them come once the page
// is live (texts/en/late.ts); until then those are not known.

import { robot } from '../texts/en/robot';
import { fix_words, type Fix } from './vehicle';
import { filled, language_now, late_now, say_plain, type LateTexts, type PlainKey } from './say';

type Key = keyof typeof robot | keyof LateTexts;

interface Sentence {
  readonly key: Key;
  readonly pattern: RegExp;
  readonly names: readonly string[];
}

/** What is filled in where nothing else is said of it: a name, as of a sensor or a mode, that
 * takes no more of the sentence. */
const NAME = '[^;:,()"]+?';
const FIGURE = String.raw`-?\d+(?:\.\d+)?(?: ?(?:m|cm|mm|km|s|min|h|deg|%|m/s))?`;
const FILLED: Readonly<Record<string, string>> = {
  ...Object.fromEntries(['n', 'has', 'line'].map((name) => [name, String.raw`\d+`])),
  ...Object.fromEntries(
    ['m', 'time', 'far', 'most', 'least', 'need', 'wide', 'driven', 'charge', 'angle', 'deg'].map(
      (name) => [name, FIGURE],
    ),
  ),
  value: String.raw`[-+.\de]+`,
  parameter: String.raw`[\w.]+`,
  device: String.raw`[\w.]+`,
  swi: 'SW[A-D]',
  // Names of people and devices, and values, as they are; what a person wrote.
  ...Object.fromEntries(['who', 'other', 'old', 'new'].map((name) => [name, '[^;]+?'])),
  words: '.+',
  // As it stands in a file.
  column: '.+?',
};
/** Filled in are sentences of the robot, too: only where they are known, so is what holds them. */
const SENTENCES: ReadonlySet<string> = new Set(['why', 'what', 'where']);
const DEEPEST = 8;
const KEPT = 500;

const escaped = (text: string): string => text.replace(/[.*+?^${}()|[\]\\]/g, '\\$&');

const pattern_of = (name: string, before: string): string => {
  if (SENTENCES.has(name)) return '.+?';
  return FILLED[name] ?? (before.endsWith('"') ? '[^"]+' : NAME);
};

const sentence_of = (key: Key, text: string): Sentence => {
  const parts = text.split(/\{(\w+)\}/);
  const names = parts.filter((_, k) => k % 2 === 1);
  const source = parts.map((part, k) =>
    k % 2 === 0 ? escaped(part) : `(${pattern_of(part, parts[k - 1] ?? '')})`,
  );
  return { key, names, pattern: new RegExp(`^${source.join('')}$`, 's') };
};

/** Those that hold a sentence are looked for first, then those that say most themselves. */
const own_letters = (text: string): number =>
  text.replace(/\{\w+\}/g, '').length + (/\{(why|what)\}/.test(text) ? 1000 : 0);

interface Known {
  readonly whole: ReadonlyMap<string, Key>;
  readonly open: readonly Sentence[];
}

const known_by = (texts: Partial<Readonly<Record<Key, string>>>): Known => {
  const sorted = (Object.entries(texts) as [Key, string][]).sort(
    ([, a], [, b]) => own_letters(b) - own_letters(a),
  );
  const open = sorted.filter(([, text]) => text.includes('{'));
  return {
    whole: new Map(sorted.map(([key, text]) => [text, key])),
    open: open.map(([key, text]) => sentence_of(key, text)),
  };
};

const at_first = known_by(robot);
let with_late: Known | null = null;
const known = (): Known => {
  const late = late_now();
  if (!late) return at_first;
  with_late ??= known_by({ ...robot, ...late });
  return with_late;
};

const said = (key: Key): string => say_plain(key as PlainKey);

/** Sentences, one after the other, each of which is known: one may hold a "; " itself. */
const joined_in_words = (text: string, depth: number): string | null => {
  for (let at = text.indexOf('; '); at >= 0; at = text.indexOf('; ', at + 1)) {
    const first = single_in_words(text.slice(0, at), depth);
    const rest = first === null ? null : in_words(text.slice(at + 2), depth + 1);
    if (rest !== null) return `${first}; ${rest}`;
  }
  return null;
};

/** A fix has its own words on the page: "RTK fixed", and "no fix" within a sentence. */
const plain_words = (name: string, value: string): string => {
  if (name !== 'fix' || !Object.hasOwn(fix_words, value)) return value;
  const words = fix_words[value as Fix];
  return /^.\p{Ll}/u.test(words) ? words.charAt(0).toLowerCase() + words.slice(1) : words;
};

/** @return null: the pattern does not fit, or what fills it is not known */
const filled_in_words = ({ key, names, pattern }: Sentence, text: string, depth: number) => {
  const match = pattern.exec(text);
  if (!match) return null;
  const values: [string, string][] = [];
  for (const [k, name] of names.entries()) {
    const value = match[k + 1] ?? '';
    const words = SENTENCES.has(name) ? in_words(value, depth + 1) : plain_words(name, value);
    if (words === null) return null;
    values.push([name, words]);
  }
  return filled(said(key), Object.fromEntries(values));
};

const single_in_words = (text: string, depth: number): string | null => {
  const key = known().whole.get(text);
  if (key) return said(key);
  for (const sentence of known().open) {
    const words = filled_in_words(sentence, text, depth);
    if (words !== null) return words;
  }
  return null;
};

/** All of it, never a part: half a sentence would be read out in the wrong language. @return null: it is
 * none that is known */
const in_words = (text: string, depth: number): string | null => {
  if (depth > DEEPEST) return null;
  const key = known().whole.get(text);
  if (key) return said(key);
  return joined_in_words(text, depth) ?? single_in_words(text, depth);
};

const found = new Map<string, string | null>();

const found_in_words = (text: string): string | null => {
  const name = `${language_now()}${late_now() ? '+' : ''} ${text}`;
  if (!found.has(name)) {
    if (found.size >= KEPT) found.clear();
    found.set(name, in_words(text, 0));
  }
  return found.get(name) ?? null;
};

/** Whether this page has words of its own for it. */
export const is_known_sentence = (text: string): boolean => in_words(text, 0) !== null;

/** In the language that is chosen; one that this page does not know is as it came. */
export const robot_says = (text: string): string =>
  language_now() === 'en' ? text : (found_in_words(text) ?? text);

/** The language that it is then in; undefined: the page's own. */
export const language_said = (text: string): 'en' | undefined =>
  language_now() !== 'en' && found_in_words(text) === null ? 'en' : undefined;
