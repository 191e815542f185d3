// What the robot says in English, in the language of the page. It has stable words for kinds of events and
// conditions, but says why in sentences, with figures in them; those that people meet in the field are in
// the texts (texts/en/robot.ts), and are known by how they read in English.

import { robot } from '../texts/en/robot';
import { filled, language_now, say_plain, type PlainKey } from './say';

type Key = keyof typeof robot;

interface Sentence {
  readonly key: Key;
  readonly pattern: RegExp;
  readonly names: readonly string[];
}

/** Filled in are sentences of the robot, too. */
const SENTENCES: ReadonlySet<string> = new Set(['why', 'what', 'where']);
const NUMBERS: ReadonlySet<string> = new Set(['n', 'has', 'line']);
const DEEPEST = 4;
const KEPT = 500;

const escaped = (text: string): string => text.replace(/[.*+?^${}()|[\]\\]/g, '\\$&');

const sentence_of = (key: Key, text: string): Sentence => {
  const parts = text.split(/\{(\w+)\}/);
  const names = parts.filter((_, k) => k % 2 === 1);
  const source = parts.map((part, k) =>
    k % 2 === 0 ? escaped(part) : NUMBERS.has(part) ? '(\\d+)' : '(.+?)',
  );
  return { key, names, pattern: new RegExp(`^${source.join('')}$`, 's') };
};

/** Those that hold a sentence are looked for first, then those that say most themselves. */
const own_letters = (text: string): number =>
  text.replace(/\{\w+\}/g, '').length + (/\{(why|what)\}/.test(text) ? 1000 : 0);

const known = (Object.entries(robot) as [Key, string][]).sort(
  ([, a], [, b]) => own_letters(b) - own_letters(a),
);
const whole = new Map(known.map(([key, text]) => [text, key]));
const open = known
  .filter(([, text]) => text.includes('{'))
  .map(([key, text]) => sentence_of(key, text));

const said = (key: Key): string => say_plain(key as PlainKey);

/** @return null: it is none that is known */
const in_words = (text: string, depth: number): string | null => {
  const key = whole.get(text);
  if (key) return said(key);
  if (depth > DEEPEST) return null;
  for (const { key: open_key, names, pattern } of open) {
    const match = pattern.exec(text);
    if (!match) continue;
    const values = names.map((name, k): [string, string] => {
      const value = match[k + 1] ?? '';
      return [name, SENTENCES.has(name) ? (in_words(value, depth + 1) ?? value) : value];
    });
    return filled(said(open_key), Object.fromEntries(values));
  }
  const parts = text.split('; ');
  const words = parts.map((part) => (parts.length > 1 ? in_words(part, depth + 1) : null));
  if (words.every((word) => word === null)) return null;
  return words.map((word, k) => word ?? parts[k]).join('; ');
};

const found = new Map<string, string | null>();

const found_in_words = (text: string): string | null => {
  const name = `${language_now()} ${text}`;
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
