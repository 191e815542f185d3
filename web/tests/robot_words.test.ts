// The robot's sentences in the languages of the page; and that a new one of the robot's is noticed here.

import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { afterEach, describe, expect, test } from 'vitest';

import { is_known_sentence, language_said, robot_says } from '../src/model/robot_words';
import { IN_ENGLISH, speak } from '../src/model/say';
import { english } from '../src/texts/en';
import { finnish } from '../src/texts/fi';

const SERVER = join(import.meta.dirname, '../../server');

/** What a person meets in the field: refusals of commands, failsafes and checks, the place in a map. */
const SOURCES: readonly (readonly [files: RegExp, sentences: RegExp])[] = [
  [/^robot\/.*\.cpp$/, /Code::(?:Conflict|Late),\s*"([^"]+)"\)/g],
  [/^nav\/behave\/executor\.cpp$/, /Code::Conflict,\s*"([^"]+)"\)/g],
  [/^robot\/safety\/failsafes_\w+\.cpp$/, /return "([a-z]\w* [^"]+)";/g],
  [
    /^robot\/safety\/(safety|arm_switch)\.cpp$/,
    /(?:return|Severity::Error,|[?:]) "([a-z]\w* [^"]+)"[);:]/g,
  ],
  [/^nav\/place\/\w+\.cpp$/, /(?:return|reason =|[?:]) "([a-z]\w* [^"]+)"[;\s]/g],
  [
    /^mission\/formats\/(kml|csv|gpx)_file\.cpp$/,
    /detail = "([^"]+)";|refuse\([^"]*"row",\s*"([^"]+)"\)/g,
  ],
];
/** Said in English in all languages; the list only ever gets shorter. */
const STILL: ReadonlySet<string> = new Set([
  // Asked for by whoever sets it up.
  'nothing is known of the vehicle that could be forgotten',
  "nothing is taken from the antennas' headings",
  'something slows the robot: it could not be measured',
  'the run has no track',
  "the receiver's positions have not moved",
  'the two antennas were not seen to be askew',
  'there is no anchor',
  'there is no map yet that east and north could be of: give lat and lon, load a mission, or set nav.estimate.map_lat and map_lon',
  'there is no position from GNSS that could be anchored',
]);

afterEach(() => speak(() => IN_ENGLISH));
const in_finnish = (): void => speak(() => ({ language: 'fi', texts: finnish }));

describe('what the robot says', () => {
  test('stays as it is in English, and where it is not known', () => {
    expect(robot_says('the radio drives')).toBe('the radio drives');
    in_finnish();
    expect(robot_says('the moon is full')).toBe('the moon is full');
    expect(language_said('the moon is full')).toBe('en');
    expect(language_said('the radio drives')).toBeUndefined();
  });

  test('is said in the language that is chosen, with its figures', () => {
    in_finnish();
    expect(robot_says('the radio drives')).toBe('radio ohjaa');
    expect(robot_says('no word from the base for 1.2 s')).toBe('ajoneuvosta ei ole kuultu: 1.2 s');
  });

  test('is said part by part where one sentence holds others', () => {
    in_finnish();
    expect(robot_says('not armed: the GNSS receiver is silent (and 2 more)')).toBe(
      'ei aktivoitu: GNSS-vastaanotinta ei kuulu (ja 2 muuta)',
    );
    expect(robot_says('two receivers say different places; the item in hand needs none')).toBe(
      'kaksi vastaanotinta kertoo eri paikat; meneillään oleva kohta ei tarvitse sijaintia',
    );
    expect(robot_says('item 3: the row is lost')).toBe('kohta 3: rivi on kadonnut');
    expect(robot_says('something stands in the way, 1.2 m ahead, to the left, seen by front')).toBe(
      'jotakin on tiellä, 1.2 m edessä vasemmalla, sen näki front',
    );
  });

  test('says of a mission by a map why it is not taken, with what helps', () => {
    in_finnish();
    const looking =
      'looking for the place in the map; drive some metres by hand: a tap does not help before, ' +
      'for nobody knows where on the earth the map lies';
    const refused = `the mission counts from the map "hall": the robot is not found in it yet (${looking})`;
    expect(robot_says(refused)).toMatch(/^tehtävä lasketaan kartasta ”hall”: .*\(.*; aja muutama/);
    expect(robot_says(refused)).not.toContain('the');
  });

  test('is said of files of missions, too', () => {
    in_finnish();
    expect(robot_says('a waypoint has no place for it')).toBe(
      'reittipisteessä ei ole sille paikkaa',
    );
    expect(robot_says('not a KMZ file that can be read: there is no .kml in it')).toBe(
      'ei ole luettava KMZ-tiedosto: siinä ei ole yhtään .kml-tiedostoa',
    );
    expect(robot_says('column 2 must be a finite number, of degrees with decimals')).toBe(
      'sarakkeen 2 on oltava äärellinen luku, asteita desimaalein',
    );
  });

  test('is never taken for a shorter sentence that begins the same', () => {
    in_finnish();
    for (const [key, text] of Object.entries(english)) {
      if (!key.startsWith('rb_') || typeof text !== 'string') continue;
      const spoken = (finnish as unknown as Readonly<Record<string, string>>)[key];
      const plain = text.replaceAll(/\{(n|has|line)\}/g, '7').replaceAll(/\{\w+\}/g, 'x');
      const wanted = spoken?.replaceAll(/\{(n|has|line)\}/g, '7').replaceAll(/\{\w+\}/g, 'x');
      expect(robot_says(plain), plain).toBe(wanted);
    }
  });

  test('in the field has words in every language: a new sentence is put into texts/en/robot.ts', () => {
    const all = readdirSync(SERVER, { recursive: true }).map((name) => String(name));
    const missing = new Set<string>();
    let seen = 0;
    for (const [files, sentences] of SOURCES) {
      for (const file of all.filter((name) => files.test(name))) {
        const source = readFileSync(join(SERVER, file), 'utf8').replace(/"\s*\n\s*"/g, '');
        for (const [, one, other] of source.matchAll(sentences)) {
          const text = one ?? other ?? '';
          seen += 1;
          if (!is_known_sentence(text)) missing.add(text);
        }
      }
    }
    expect(seen).toBeGreaterThan(60);
    expect([...missing].sort()).toEqual([...STILL].sort());
  });
});
