// What the page says, in the language that is chosen. Texts stand in files (src/texts), one room for each
// language; here is how one is looked up and filled in. English is always there; a text that another
// language does not have yet is said in English, never as its key.

import { english } from '../texts/en';
import type { late } from '../texts/en/late';

export type English = typeof english;
export type Key = keyof English;
/** A text that goes by a number: the forms that the language has, by the names of Intl.PluralRules. */
export type Plural = { readonly other: string } & {
  readonly [Form in Exclude<Intl.LDMLPluralRule, 'other'>]?: string;
};
/** Every text of one language. */
export type Texts = {
  readonly [K in Key]: English[K] extends string ? string : Plural;
};

export const LANGUAGES = ['en', 'fi', 'et', 'it', 'nb'] as const;
export type Language = (typeof LANGUAGES)[number];
/** Each in its own words: whoever looks for it reads those. */
export const language_names: Readonly<Record<Language, string>> = {
  en: 'English',
  fi: 'Suomi',
  et: 'Eesti',
  it: 'Italiano',
  nb: 'Norsk',
};

/** The robot's sentences that come once the page is live (texts/en/late.ts). */
export type LateTexts = Readonly<Record<keyof typeof late, string>>;

export interface Spoken {
  readonly language: Language;
  readonly texts: Partial<Texts & LateTexts>;
  /** How the robot says those in English; nothing: they are not here yet, or not needed, as in English. */
  readonly late?: LateTexts;
}
export const IN_ENGLISH: Spoken = { language: 'en', texts: english };

/** Who knows what is spoken just now; what reads it in a panel is drawn anew when it changes. */
let spoken: () => Spoken = () => IN_ENGLISH;
export const speak = (source: () => Spoken): void => {
  spoken = source;
};

/** The names in braces of a text. */
type Names<T extends string> = T extends `${string}{${infer Name}}${infer Rest}`
  ? Name | Names<Rest>
  : never;
type Words<T> = T extends string
  ? T
  : T extends { readonly other: infer O extends string }
    ? O
    : never;
/** What nobody knows is nothing on the page. */
type Value = string | number | null | undefined;
type Values<K extends Key> = [Names<Words<English[K]>>] extends [never]
  ? []
  : [values: Readonly<Record<Names<Words<English[K]>>, Value>>];

/** Putting a text's values where their names stand. */
export const filled = (text: string, values: Readonly<Record<string, Value>> = {}): string =>
  text.replace(/\{(\w+)\}/g, (whole, name: string) =>
    name in values ? String(values[name] ?? '') : whole,
  );

const rules = new Map<Language, Intl.PluralRules>();
const form_of = (n: number, language: Language): Intl.LDMLPluralRule => {
  const known = rules.get(language) ?? new Intl.PluralRules(language);
  rules.set(language, known);
  return known.select(n);
};

/** @param values for each name in the text's braces; a plural goes by its `n` */
export const say = <K extends Key>(key: K, ...[values]: Values<K>): string => {
  const { language, texts } = spoken();
  const text: string | Plural = texts[key] ?? english[key];
  if (typeof text === 'string') return filled(text, values);
  const n = Number((values as Readonly<Record<string, Value>> | undefined)?.['n']);
  return filled(text[form_of(n, texts[key] ? language : 'en')] ?? text.other, values);
};

/** Texts without names to fill in. */
export type PlainKey = {
  [K in Key]: English[K] extends string ? ([Names<English[K]>] extends [never] ? K : never) : never;
}[Key];

/** A table of texts that stays right when the language changes: each is looked up when it is read. */
export const told = <Name extends string>(
  keys: Readonly<Record<Name, PlainKey>>,
): Readonly<Record<Name, string>> => {
  const table = {};
  for (const [name, key] of Object.entries<PlainKey>(keys)) {
    Object.defineProperty(table, name, { get: () => say_plain(key), enumerable: true });
  }
  return table as Readonly<Record<Name, string>>;
};

/** Of a key that is chosen at run time. */
export const say_plain = (key: PlainKey): string => {
  const text: unknown = spoken().texts[key] ?? english[key];
  return String(text);
};

export const language_now = (): Language => spoken().language;
export const late_now = (): LateTexts | undefined => spoken().late;

const signs = new Map<Language, string>();
/** Between whole and parts: "." or ",". Only where a person reads it; fields and files keep the point. */
export const decimal_sign = (): string => {
  const { language } = spoken();
  const sign = signs.get(language) ?? (1.5).toLocaleString(language).charAt(1);
  signs.set(language, sign);
  return sign;
};

/** What a device asks for ("nb-NO", "no", "fi"), best first; English where nothing fits. */
export const language_of = (wished: readonly string[]): Language => {
  for (const each of wished) {
    const name = each.toLowerCase().split('-')[0] ?? '';
    const folded = name === 'no' || name === 'nn' ? 'nb' : name;
    const found = LANGUAGES.find((language) => language === folded);
    if (found) return found;
  }
  return 'en';
};
