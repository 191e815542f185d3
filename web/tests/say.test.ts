// How a text is found and filled in, and that every language has all of them.

import { afterEach, describe, expect, test } from 'vitest';

import { shortest } from '../src/model/figures';
import { accuracy, age, coordinates, day_and_time, metres, number_text } from '../src/model/format';
import {
  decimal_sign,
  filled,
  IN_ENGLISH,
  language_of,
  LANGUAGES,
  say,
  speak,
  told,
  type Language,
  type LateTexts,
  type Plural,
  type Texts,
} from '../src/model/say';
import { english } from '../src/texts/en';
import { late as english_late } from '../src/texts/en/late';
import { robot_around } from '../src/texts/en/robot_around';
import { robot_files } from '../src/texts/en/robot_files';
import { estonian } from '../src/texts/et';
import { late as estonian_late } from '../src/texts/et/late';
import { finnish } from '../src/texts/fi';
import { late as finnish_late } from '../src/texts/fi/late';
import { italian } from '../src/texts/it';
import { late as italian_late } from '../src/texts/it/late';
import { norwegian } from '../src/texts/nb';
import { late as norwegian_late } from '../src/texts/nb/late';

const all: Readonly<Record<Exclude<Language, 'en'>, Texts>> = {
  fi: finnish,
  et: estonian,
  it: italian,
  nb: norwegian,
};
/** Those that come once the page is live. */
const all_late: Readonly<Record<Exclude<Language, 'en'>, LateTexts>> = {
  fi: finnish_late,
  et: estonian_late,
  it: italian_late,
  nb: norwegian_late,
};
const in_language = (language: Exclude<Language, 'en'>): void =>
  speak(() => ({ language, texts: all[language] }));

afterEach(() => speak(() => IN_ENGLISH));

describe('what is said', () => {
  test('is English at first, with its values where their names stand', () => {
    expect(say('pause')).toBe('Pause');
    expect(say('mode_mode', { mode: 'HOLD' })).toBe('Mode HOLD');
    expect(filled('{a} of {b}, {c}', { a: 1, b: null })).toBe('1 of , {c}');
  });

  test('goes by the number, in the forms of the language', () => {
    expect([0, 1, 2].map((n) => say('n_item', { n }))).toEqual(['0 items', '1 item', '2 items']);
    in_language('fi');
    expect([0, 1, 2].map((n) => say('n_item', { n }))).toEqual(['0 kohtaa', '1 kohta', '2 kohtaa']);
    in_language('it');
    expect(say('n_item', { n: 1_000_000 })).toBe('1000000 elementi'); // "many" has no text of its own
  });

  test('a table follows the language that is spoken when it is read', () => {
    const words = told({ hold: 'pause' });
    expect(words.hold).toBe('Pause');
    in_language('nb');
    expect(words.hold).toBe('Pause');
    in_language('fi');
    expect(words.hold).toBe('Tauko');
    expect({ ...words }).toEqual({ hold: 'Tauko' });
  });

  test('is English where a language has no text yet, never the key', () => {
    speak(() => ({ language: 'et', texts: {} }));
    expect(say('pause')).toBe('Pause');
    expect(say('n_item', { n: 1 })).toBe('1 item');
  });

  test('the language is the first that the device asks for and the page has', () => {
    expect(language_of(['de-DE', 'fi-FI', 'en'])).toBe('fi');
    expect(['no', 'nn-NO', 'nb'].map((one) => language_of([one]))).toEqual(['nb', 'nb', 'nb']);
    expect(language_of(['en-GB', 'fi'])).toBe('en');
    expect(language_of(['zh'])).toBe('en');
    expect(language_of([])).toBe('en');
  });

  test('people read a comma in figures where their language has one, and places keep the point', () => {
    expect(decimal_sign()).toBe('.');
    expect([metres(12.34), number_text(-0.5, 1, 'V')]).toEqual(['12.3 m', '−0.5 V']);
    in_language('et');
    expect([metres(12.34), number_text(-0.5, 1, 'V')]).toEqual(['12,3 m', '−0,5 V']);
    expect([age(4.21), accuracy(2.5), shortest(0.5, 2)]).toEqual(['4,2 s', '±2,5 m', '0,5']);
    expect(coordinates({ lat: 58.5, lon: 26.25 })).toBe('58.5000000, 26.2500000');
  });

  test('a day is written as the language does, and nobody takes its month for the day', () => {
    const stamp = '2026-05-02T09:05:10.000';
    const written = (language: Exclude<Language, 'en'>): string => {
      in_language(language);
      return day_and_time(stamp);
    };
    expect(day_and_time(stamp)).toBe('2 May 2026, 09:05');
    expect(written('fi')).toBe('2.5.2026, 09:05');
    expect(written('et')).toBe('2. mai 2026, 09:05');
    expect(written('it')).toBe('2 mag 2026, 09:05');
    expect(written('nb')).toBe('2. mai 2026, 09:05');
    expect(day_and_time('never')).toBe('—');
  });
});

const names_in = (text: string): string[] => [...text.matchAll(/\{\w+\}/g)].map(String).sort();
const forms_of = (text: string | Plural): readonly string[] =>
  typeof text === 'string' ? [text] : Object.values(text);
const forms_needed = (language: Language): string[] =>
  [0, 1, 2, 5, 11, 21, 100].map((n) => new Intl.PluralRules(language).select(n));

describe.each(Object.entries(all))('the texts of %s', (language, texts) => {
  const late = all_late[language as Exclude<Language, 'en'>];

  test('are all there, and none besides', () => {
    expect(Object.keys(texts).sort()).toEqual(Object.keys(english).sort());
    expect(Object.keys(late).sort()).toEqual(Object.keys(english_late).sort());
  });

  test('have the same names to fill in as the English, and are not empty', () => {
    const others: Readonly<Record<string, string | Plural>> = { ...texts, ...late };
    for (const [key, text] of Object.entries<string | Plural>({ ...english, ...english_late })) {
      const other = others[key] ?? '';
      expect(typeof other, key).toBe(typeof text);
      for (const form of forms_of(other)) {
        expect(form.trim(), key).not.toBe('');
        const wanted = names_in(typeof text === 'string' ? text : text.other);
        // "one" may say it in a word: "restarted once".
        const may_lack_n = typeof text !== 'string' && form === (other as Plural).one;
        const has = names_in(form);
        expect(may_lack_n && !has.includes('{n}') ? [...has, '{n}'].sort() : has, key).toEqual(
          wanted,
        );
      }
    }
  });

  test('have each form of a plural that the language knows', () => {
    for (const [key, text] of Object.entries<string | Plural>(texts)) {
      if (typeof text === 'string') continue;
      for (const form of forms_needed(language as Language)) expect(text, key).toHaveProperty(form);
    }
  });

  test('say “STOP” as it is: the word is on the button in every language', () => {
    expect(texts.stop_caps).toBe('STOP');
    expect(texts.emergency_stop).toMatch(/^STOP/);
  });
});

test('none that comes late hides another', () => {
  expect(Object.keys(english_late).filter((key) => key in english)).toEqual([]);
  expect(Object.keys(robot_around).filter((key) => key in robot_files)).toEqual([]);
});

test('every language that can be chosen has texts', () => {
  expect(['en', ...Object.keys(all)].sort()).toEqual([...LANGUAGES].sort());
});
