// The robot's sentences in the languages of the page; and that a new one of the robot's is noticed here.

import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { afterEach, describe, expect, test } from 'vitest';

import { is_known_sentence, language_said, robot_says } from '../src/model/robot_words';
import { IN_ENGLISH, speak } from '../src/model/say';
import { english } from '../src/texts/en';
import { late as english_late } from '../src/texts/en/late';
import { robot_events } from '../src/texts/en/robot_events';
import { finnish } from '../src/texts/fi';
import { late as finnish_late } from '../src/texts/fi/late';

const SERVER = join(import.meta.dirname, '../../server');

/** What a person meets in the field, where it is a whole sentence and not joined from parts: refusals of commands, failsafes and checks, the place in a map. */
const SOURCES: readonly (readonly [files: RegExp, sentences: RegExp])[] = [
  [/^robot\/.*\.cpp$/, /Code::(?:Conflict|Late),\s*"([^"]+)"\)/g],
  [/^nav\/behave\/executor\.cpp$/, /Code::Conflict,\s*"([^"]+)"\)/g],
  [/^robot\/safety\/failsafes_\w+\.cpp$/, /return "([a-z]\w* [^"]+)";/g],
  [
    /^robot\/safety\/(safety|arm_switch)\.cpp$/,
    /(?:return|Severity::Error,|[?:]) "([a-z]\w* [^"]+)"[);:]/g,
  ],
  [/^nav\/place\/\w+\.cpp$/, /(?:return|reason =|[?:])\s+"([a-z]\w* [^"]+)"[;\s]/g],
  [
    /^mission\/formats\/(kml|csv|gpx|geojson)_file\.cpp$/,
    /kNoPosition =\s*"([^"]+)";|refuse\([^";]*"([a-z][^"]+)"\)/g,
  ],
  [
    /^mission\/formats\/\w+\.cpp$/,
    /(?:leave_out|change|change_row|note_item|note)\([^;"]*(?:"[a-z_]+",\s*)?"([a-z0-9/]+ [^"]*[a-z])"\)/g,
  ],
  [
    /^mission\/formats\/\w+\.cpp$/,
    /(?:[?:]|reason =|note =|kNoCommand =|LeftOut,|std::string\()\s*"([a-z0-9/]+ [^"]*[a-z])"[;),]/g,
  ],
  [/^mission\/formats\/csv_columns\.cpp$/, /none\([\w:]+,\s*"([^"]+)"\)/g],
  [/^mission\/formats\/kmz_file\.cpp$/, /(?:bad_archive\(|why = )"([^"]+)"[;)]/g],
  [/^robot\/guard\/\w+\.cpp$/, /return "([a-z]\w* [^"]+)";/g],
  [/^robot\/guard\/watched\.cpp$/, /(?:told\(|again =|[?:])\s*"([a-z]\w* [^"]+)"[;:)\s]/g],
  [/^nav\/around\/around\.cpp$/, /return "([a-z]\w* \w+ [^"]+)";/g],
  [/^robot\/modes\/around\.cpp$/, /(?:"no_way_around",|\?) "([a-z]\w* [^"]+[a-z])"[);\n]/g],
  [
    /^robot\/.*\.cpp$/,
    /event\((?:base::)?Severity::\w+, (?:\w+ \? )?"\w+"(?: : "\w+")?,\s*(?:[\w.]+\s*\? )?"([^"]+)"(?:\)|\s*:)/g,
  ],
  [/^robot\/.*\.cpp$/, /change_mode\(ModeCause::\w+, (?:\w+ \? )?"([^"]+)"(?:\)| :)/g],
  [
    /^robot\/modes\/(?:\w+)\.hpp$/,
    /(?:return|lock\(|cause_ =|kSilent =|[?:]) "([a-z]\w* [^"]*[^" ])"/g,
  ],
  [/^robot\/modes\/self_driving\.cpp$/, /reached\("\w+",\s*"([^"]+)"\)/g],
  [/^robot\/radio\/keys\.cpp$/, /\{"[\w.]+", "([^"]+)", RadioDeed/g],
  [/^robot\/safety\/(?:estimate|votes)_watch\.cpp$/, /return "([^"]+)";|"\w+",\s*"([^"]+)"\)/g],
  [/^robot\/safety\/estimate_watch\.cpp$/, /health\.\w+, "([^"]+)"\}/g],
  [/^robot\/safety\/safety\.cpp$/, /\? "(none)" :/g],
  [/^robot\/safety\/reset_latch\.hpp$/, /why = "([^"]+)"/g],
  [/^robot\/world\.hpp$/, /end_good\("([^"]+)"/g],
  [/^app\/host_watch\.cpp$/, /(?:"clock_unset",|std::string\()\s*"([^"]+)"/g],
  [/^app\/station_opening\.cpp$/, /tell_drawing\("\w+", "([^"]+)"\)/g],
  [/^services\/\w+\.cpp$/, /Severity::\w+, "\w+",\s*"([^"]+)"\}?\)/g],
  [/^nav\/sense\/health\.cpp$/, /(?:say\(Eye::\w+,|[?:]) "([a-z]\w* [^"]+)"\s?[:)]/g],
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

/** Where the server joins what stands between two figures or names from parts. */
const JOINED: readonly string[] = [
  'disarmed |because |somebody else commands the base',
  'emergency stop| by |the page or a script',
  'emergency stop| by |the radio',
  'emergency stop| by |the operator',
  'emergency stop| by |the button at the base',
  'emergency stop| by |the bumper',
  'emergency stop| by',
  'paused |by the radio',
  'stopped |by the radio',
  'home| missed by',
  'is taken by |map',
  'is taken by |that of the configuration|: give another one, or rename that map',
  'deg|: the robot will creep at first',
  'no wall is seen on the |left',
  'no wall is seen on the |right',
  'no wall is seen on the |left| within',
  'no wall is seen on the |right| within',
  'no |landmark| is seen',
  'no |landmark| is seen within',
  'no |landmark| is seen any more',
  'its way ends before the |landmark| is passed',
  'the hand on the speed |is silent|: let go and hold it again, or hold the robot (HOLD) and go on',
  'the hand on the speed |has left|: let go and hold it again, or hold the robot (HOLD) and go on',
  'ago|: waiting',
  'while it was disarmed|: look where the robot stands',
  'position| set anew, moved by',
  'heading| set anew, moved by',
  'the estimate| set anew, moved by',
  'the robot stands at |item',
  'the robot stands at |the given point|: positions are moved by',
  'acknowledged |by the operator',
  'deg/s| farther left| than',
  'deg/s| farther right| than',
  'deg| farther left| than',
  'deg| farther right| than',
  'is |opening',
  'is |down',
  'is |faulty',
  'is |failed',
];

afterEach(() => speak(() => IN_ENGLISH));
const all_finnish = { ...finnish, ...finnish_late };
const in_finnish = (): void =>
  speak(() => ({ language: 'fi', texts: all_finnish, late: english_late }));

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

  test.each([
    [
      'blocked: something stands in the way, 1.2 m ahead, seen by front; it waits until the way is clear',
      'tie on tukossa: jotakin on tiellä, 1.2 m edessä, sen näki front; se odottaa, kunnes tie on vapaa',
    ],
    [
      'blocked: the ground ends, 0.8 m ahead, seen by front (sense.ground.drop_m): the trailer would touch it',
      'tie on tukossa: maa päättyy, 0.8 m edessä, sen näki front (sense.ground.drop_m): perävaunu osuisi siihen',
    ],
    [
      'the guard is overridden by anna: something stands in the way, 1.2 m ahead',
      'estevahdin on ohittanut anna: jotakin on tiellä, 1.2 m edessä',
    ],
    [
      'the sensor front does not see: it is silent: nothing drives by itself',
      'anturi front ei näe: siitä ei kuulu mitään: mikään ei aja itsestään',
    ],
    [
      'can0: somebody else commands the base; can1: somebody else commands the base',
      'can0: joku muu ohjaa ajoneuvoa; can1: joku muu ohjaa ajoneuvoa',
    ],
    [
      'the file has 1 wrong value: line 2 latitude must be from -90 to 90, is 95',
      'tiedostossa on yksi väärä arvo: rivi 2 leveysasteen on oltava -90…90, on 95',
    ],
    ['charge is 20 %; the row is lost', 'akun varaus on 20 %; rivi on kadonnut'],
    [
      'must name lat and lon, or x and y, each once: column lat [ft] is no latitude in degrees or radians',
      'rivin on nimettävä lat ja lon tai x ja y, kukin kerran: sarake lat [ft] ei ole leveysaste asteina tai radiaaneina',
    ],
  ])('is said whole where one sentence follows another: %s', (text, words) => {
    in_finnish();
    expect(robot_says(text)).toBe(words);
    expect(language_said(text)).toBeUndefined();
  });

  test.each([
    ['item 2 reached', 'kohta 2 saavutettu'],
    ['mission "north; 2" revision 3 started', 'tehtävä ”north; 2”, versio 3, alkoi'],
    ['mode AUTO: mission resumed', 'tila AUTO: tehtävä jatkuu'],
    ['mode HOLD: by the operator', 'tila HOLD: käyttäjän käskystä'],
    ['mode HOLD: item 3: the row is lost', 'tila HOLD: kohta 3: rivi on kadonnut'],
    ['GNSS fix is rtk_fixed', 'GNSS-ratkaisu on RTK fix'],
    ['no usable fix: none', 'ei käyttökelpoista ratkaisua: ei sijaintia'],
    [
      'fix rtk_float, waiting 4 s more, at most, to see whether its positions wander',
      'ratkaisu RTK float, enintään 4 s vielä, että nähdään, vaeltavatko sen sijainnit',
    ],
    [
      'fix rtk_fixed, but its positions contradicted other sensors, 3 s ago: waiting 9 s more to trust it',
      'ratkaisu RTK fix, mutta sen sijainnit olivat ristiriidassa muiden anturien kanssa 3 s sitten: luottamiseen vielä 9 s',
    ],
    [
      'fix rtk_fixed, waiting 6 s more to trust it: it had no fix 4 s ago',
      'ratkaisu RTK fix, luottamiseen vielä 6 s: sillä ei ollut ratkaisua 4 s sitten',
    ],
    ['uncertain by 2 deg', 'epävarmuus 2°'],
    [
      'SWC middle: mode AUTO refused: the emergency stop is latched',
      'SWC keskellä: tila AUTO, evätty: hätäseis on lukittuna',
    ],
    [
      "the gyro turns 3.1 deg/s farther left than the compass, odometry and the two antennas' heading say; it repeats itself: it is left out",
      'gyro kääntyy 3.1°/s enemmän vasemmalle kuin kompassi, odometria ja kahden antennin suunta; se toistaa itseään: se jätetään pois',
    ],
    ['the control loop wakes up to 65.5 ms late', 'ohjaussilmukka herää jopa 65.5 ms myöhässä'],
    [
      'gnss is opening; scanner is faulty: it is silent',
      'gnss avautuu; scanner on häiriössä: siitä ei kuulu mitään',
    ],
    [
      'nav.speed.max_mps was changed from 1.5 to 2 by anna',
      'nav.speed.max_mps: oli 1.5, nyt 2; muutti anna',
    ],
    [
      'anna (phone) took control from bert by force: the moon is full',
      'anna (phone) otti ohjauksen väkisin, edellinen bert: the moon is full',
    ],
    ['none', 'ei mitään'],
    ['gnss+odometry', 'GNSS ja odometria'],
  ])('is said of what happens every day: %s', (text, words) => {
    in_finnish();
    expect(robot_says(text)).toBe(words);
    expect(language_said(text)).toBeUndefined();
  });

  test.each([
    'blocked: the moon is full, 1.2 m ahead; it waits until the way is clear',
    'blocked: something stands in the way, 1.2 m ahead; the moon is full',
    'the guard is overridden by anna: the moon is full',
    'the sensor front does not see: the moon is full',
    'the moon is full, 1.2 m ahead',
    'the moon is full, seen by front',
    'can0: two bases answer; can1: somebody else commands the base',
    'charge is 20 %; the moon is full',
    'the base reports: motor 1 too hot',
    'fix rtk_fixed, but the moon is full',
    'mode HOLD: the moon is full',
    'gnss: the moon is full',
    'SWC middle: sing',
    'the gyro and the moon differ by 3.0 deg within 5.0 s, and it cannot be told which one is wrong',
  ])('stays all English where a part is not known: %s', (text) => {
    in_finnish();
    expect(robot_says(text)).toBe(text);
    expect(language_said(text)).toBe('en');
  });

  test('of a name in quotes takes whatever a person wrote', () => {
    in_finnish();
    expect(
      robot_says('the name "hall: 2; old" is taken by map 3: give another one, or rename that map'),
    ).toBe('nimi ”hall: 2; old” on kartalla 3: anna toinen nimi tai nimeä se kartta uudelleen');
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
    expect(robot_says('column 2 must be a finite number, or degrees, minutes and seconds')).toBe(
      'sarakkeen 2 on oltava äärellinen luku tai asteita, minuutteja ja sekunteja',
    );
  });

  test('stays English of files until those sentences have come, and then follows', () => {
    const left_out = 'a ground vehicle does not take off';
    speak(() => ({ language: 'fi', texts: finnish }));
    expect(robot_says(left_out)).toBe(left_out);
    expect(language_said(left_out)).toBe('en');
    expect(robot_says('the radio drives')).toBe('radio ohjaa');
    in_finnish();
    expect(robot_says(left_out)).toBe('maa-ajoneuvo ei nouse ilmaan');
    expect(language_said(left_out)).toBeUndefined();
  });

  test('is said of the rows of a file, each with all that was changed', () => {
    in_finnish();
    expect(robot_says('a height of 120000 cannot be kept; driven straight, not as a curve')).toBe(
      'korkeutta 120000 ei voi säilyttää; ajetaan suoraan, ei kaarena',
    );
    expect(robot_says('the robot stops at a fence; rally points are where it can be sent')).toBe(
      'robotti pysähtyy aidalle; kokoontumispisteisiin sen voi lähettää',
    );
    expect(
      robot_says(
        'a point of the map "hall; 2", written as a waypoint where that lies by now; its heading is lost',
      ),
    ).toBe(
      'kartan ”hall; 2” piste, kirjoitettu reittipisteeksi sinne, missä kartta nyt on; sen suunta katoaa',
    );
  });

  test('is never taken for a shorter sentence that begins the same', () => {
    in_finnish();
    const sample: Readonly<Record<string, string>> = {
      place: 'x',
      parameter: 'x.y',
      swi: 'SWA',
    };
    const fill = (text: string, why: string): string =>
      text
        .replaceAll(/\{(why|what|where)\}/g, why)
        .replaceAll(/\{(name|map|mode|state|fix|device|sensor|column)\}/g, 'x')
        .replaceAll(/\{(\w+)\}/g, (_, name: string) => sample[name] ?? '7');
    for (const [key, text] of Object.entries({ ...english, ...english_late })) {
      if (!key.startsWith('rb_') || typeof text !== 'string') continue;
      const spoken = (all_finnish as unknown as Readonly<Record<string, string>>)[key] ?? '';
      const plain = fill(text, 'the radio drives');
      expect(robot_says(plain), plain).toBe(fill(spoken, 'radio ohjaa'));
    }
  });

  test('in the field has words in every language: a new sentence is put into texts/en/robot.ts, or into what comes late', () => {
    in_finnish();
    const all = readdirSync(SERVER, { recursive: true }).map((name) => String(name));
    const missing = new Set<string>();
    let seen = 0;
    for (const [files, sentences] of SOURCES) {
      const before = seen;
      for (const file of all.filter((name) => files.test(name))) {
        const source = readFileSync(join(SERVER, file), 'utf8').replace(/"\s*\n\s*"/g, '');
        for (const [, one, other] of source.matchAll(sentences)) {
          const text = one ?? other ?? '';
          seen += 1;
          if (!is_known_sentence(text)) missing.add(text);
        }
      }
      expect(seen, `${files} ${sentences}`).toBeGreaterThan(before);
    }
    expect(seen).toBeGreaterThan(60);
    expect([...missing].sort()).toEqual([...STILL].sort());
  });

  test('every day is held to what the server says: no sentence of it stays behind alone', () => {
    const told = readdirSync(SERVER, { recursive: true })
      .map((name) => String(name))
      .filter((name) => /\.[ch]pp$/.test(name))
      .map((name) => readFileSync(join(SERVER, name), 'utf8'))
      .map((source) => source.replace(/^\s*\/\/.*$/gm, '').replace(/"\s*\n\s*"/g, ''))
      .flatMap((source) => [...source.matchAll(/"((?:[^"\\\n]|\\.)+)"/g)])
      .map(([, text = '']) => text.replaceAll('\\"', '"'))
      .join('\n');
    /** In whole words. */
    const stands = (text: string): boolean => {
      const begins = /^\w/.test(text) ? String.raw`(?<!\w)` : '';
      const ends = /\w$/.test(text) ? String.raw`(?!\w)` : '';
      const words = text.replace(/[.*+?^${}()|[\]\\]/g, String.raw`\$&`);
      return told.includes(text) && new RegExp(begins + words + ends).test(told);
    };
    const parts = Object.values(robot_events)
      .flatMap((text) => text.split(/\{\w+\}/))
      .map((part) => part.replace(/^\W+|\W+$/g, ''));
    const cut_of = (part: string): string =>
      JOINED.find((each) => each.replaceAll('|', '') === part) ?? part;
    const gone = parts.filter((part) => !cut_of(part).split('|').every(stands));
    expect(gone).toEqual([]);
  });

  test('of a map that lies nowhere is what the page looks for', () => {
    const source = readFileSync(join(SERVER, 'nav/place/whereabouts.cpp'), 'utf8');
    const said = source.replace(/"\s*\n\s*"/g, '');
    for (const key of ['rb_no_anchor', 'rb_word_counts_once_found', 'rb_no_tap_before'] as const) {
      expect(said).toContain(`"${english[key]}"`);
    }
  });
});
