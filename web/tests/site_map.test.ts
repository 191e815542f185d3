import { describe, expect, it } from 'vitest';

import { distance_m, offset_between, offset_from } from '../src/model/geo';
import {
  FORBIDDEN_CELL,
  FREE_CELL,
  OCCUPIED_CELL,
  read_cells,
  UNKNOWN_CELL,
} from '../src/model/site_cells';
import { IN_ENGLISH, speak } from '../src/model/say';
import {
  add_edit,
  allow,
  change_of,
  change_ring,
  corners,
  in_map,
  lies_anywhere,
  made_so_far,
  on_earth,
  name_of_files,
  pair_of,
  place_of_map,
  place_words,
  remove_edit,
  seen_since,
  why_not_save,
  type MapPlace,
  type SiteDraft,
  type SiteMap,
} from '../src/model/site_map';
import { for_robot } from '../src/ortho/map_picture';
import { english } from '../src/texts/en';
import { finnish } from '../src/texts/fi';

const HERE = { lat: 58.378, lon: 26.7289 };
const map: SiteMap = {
  id: 3,
  name: 'hall',
  revision: 1,
  created_at: '2026-05-01T10:00:00Z',
  width: 400,
  height: 200,
  resolution_m: 0.05,
  origin: { x_m: -5, y_m: -2, yaw_deg: 0 },
  anchor: null,
  placed: null,
  in_use: false,
  solid: false,
  size_bytes: 80_000,
  problem: null,
};
const pgm = (head: string, body: readonly number[]): Uint8Array =>
  Uint8Array.from([...new TextEncoder().encode(head), ...body]);

describe('the picture of a map', () => {
  it('is walls, free ground, what is not known and what is forbidden', () => {
    const bytes = [0, 254, 205, 89, 90, 206, 100, 101];
    const read = read_cells(pgm('P5\n4 2\n255\n', bytes), 4);
    expect(read).toMatchObject({ columns: 4, rows: 2, thinned: 4 });
    expect([...(read?.cells ?? [])]).toEqual([
      OCCUPIED_CELL,
      FREE_CELL,
      UNKNOWN_CELL,
      OCCUPIED_CELL,
      UNKNOWN_CELL,
      FREE_CELL,
      FORBIDDEN_CELL,
      UNKNOWN_CELL,
    ]);
  });
  it('may have comments in its head, and a body that looks like one', () => {
    const read = read_cells(pgm('P5 # made by a robot\n#\n1 2\n# more\n255\n', [0x23, 0x0a]), 1);
    expect(read && [...read.cells]).toEqual([OCCUPIED_CELL, OCCUPIED_CELL]);
  });
  it('is refused where it is none, is cut, or larger than what was asked for', () => {
    const bad = [
      '',
      'P5',
      'P2\n1 1\n255\n0',
      'P5\n2 2\n255\n...',
      'P5\n1 1\n65535\n..',
      'P5\n-1 1\n255\n.',
      'P5\n0 5\n255\n',
      'P51 1\n255\n.',
      'P5\n1 # never ends',
      'P5\n99999 99999\n255\n.',
    ];
    for (const text of bad) expect(read_cells(pgm(text, []), 1), text).toBeNull();
  });
});

describe('where a map lies', () => {
  //   heading 90: x to the east, y to the north
  //   heading  0: x to the north, y to the west
  it('turns with the heading of its x axis', () => {
    const point = { x_m: 3, y_m: 1 };
    const along = (heading_deg: number) =>
      offset_between(HERE, on_earth({ ...HERE, heading_deg }, point));
    expect(along(90).east_m).toBeCloseTo(3, 6);
    expect(along(90).north_m).toBeCloseTo(1, 6);
    expect(along(0).east_m).toBeCloseTo(-1, 6);
    expect(along(0).north_m).toBeCloseTo(3, 6);
    expect(along(180).east_m).toBeCloseTo(1, 6);
    expect(along(180).north_m).toBeCloseTo(-3, 6);
  });
  it('is found again from the earth, to the millimetre', () => {
    for (const heading_deg of [0, 37, 90, 200, 359]) {
      const at = { ...HERE, heading_deg };
      const point = { x_m: -71.25, y_m: 33.5 };
      expect(in_map(at, on_earth(at, point))).toEqual(point);
    }
  });
  it('has its picture turned about its lower left corner', () => {
    const at = { ...HERE, heading_deg: 90 };
    const offsets = (yaw_deg: number) =>
      corners({ ...map, origin: { ...map.origin, yaw_deg } }, at).map((c) => {
        const { east_m, north_m } = offset_between(HERE, c);
        return [Math.round(east_m * 1000) / 1000, Math.round(north_m * 1000) / 1000];
      });
    expect(offsets(0)).toEqual([
      [-5, -2],
      [15, -2],
      [15, 8],
      [-5, 8],
    ]);
    expect(offsets(90)).toEqual([
      [-5, -2],
      [-5, 18],
      [-15, 18],
      [-15, -2],
    ]);
  });
  it('is drawn as the robot drives by it, else by its anchor, else here', () => {
    const sure = { accuracy_m: 0.3, heading_accuracy_deg: 1 };
    const placed = { ...HERE, heading_deg: 91, ...sure };
    const east = offset_from(HERE, { east_m: 1, north_m: 0 });
    const told = { ...east, heading_deg: 90, ...sure };
    expect(place_of_map({ ...map, placed, anchor: told }, HERE)).toBe(placed);
    expect(place_of_map({ ...map, anchor: told }, HERE)).toBe(told);
    expect(place_of_map(map, HERE)).toEqual({ ...HERE, heading_deg: 90 });
    expect(place_of_map(map, null)).toBeNull();
    expect(lies_anywhere(map)).toBe(true);
    expect(lies_anywhere({ ...map, placed })).toBe(false);
  });
});

describe('files of a map', () => {
  const file = (name: string): File => new File(['.'], name);
  it('come in pairs', () => {
    const [yaml, image] = [file('Hall.YAML'), file('hall.pgm')];
    const cloud = new File([], 'yard.PCD');
    expect(pair_of([cloud])).toEqual({ cloud });
    expect(name_of_files({ cloud })).toBe('yard');
    expect(pair_of([cloud, image, yaml])).toContain('One map at a time');
    expect(pair_of([image, yaml])).toEqual({ yaml, image });
    expect(pair_of([])).toContain('Pick the .yaml and the .pgm');
    expect(pair_of([yaml])).toContain('.pgm or .png is missing');
    expect(pair_of([image])).toContain('.yaml is missing');
    expect(pair_of([yaml, image, file('shed.pgm')])).toContain('One map at a time');
    expect(pair_of([yaml, file('hall.bmp')])).toContain('“hall.bmp” is no part of a map');
  });

  it('go to the robot with a grey picture', async () => {
    const [yaml, image] = [file('hall.yaml'), file('hall.pgm')];
    expect(await for_robot({ yaml, image })).toEqual({ yaml, image });
    // One cell of 205, as the map server's saver writes it.
    const base64 =
      'iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGM4CwAAzwDOoP4pUAAAAABJRU5ErkJggg==';
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const made = await for_robot({ yaml, image: new File([bytes], 'hall.PNG') });
    if (typeof made === 'string' || 'cloud' in made) throw new Error('not made');
    expect(made.image.name).toBe('hall.pgm');
    expect([...new Uint8Array(await made.image.arrayBuffer())].at(-1)).toBe(205);
    expect(await for_robot({ yaml, image: file('hall.png') })).toBe('the PNG cannot be read.');
    // What is clear is one of four parts, but for the modes where it is unknown.
    const clear = Uint8Array.from(
      atob(
        'iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAQAAAC1HAwCAAAAC0lEQVR4nGM4ywAAAZ0Azj8oeDoAAAAASUVORK5CYII=',
      ),
      (letter) => letter.charCodeAt(0),
    );
    const scale = new File(['image: hall.png\nmode: scale\n'], 'hall.yaml');
    const picture = new File([clear], 'hall.png');
    expect(await for_robot({ yaml: scale, image: picture })).toContain('in the mode trinary');
    expect(typeof (await for_robot({ yaml, image: picture }))).toBe('object');
  });
});

describe('changes by hand', () => {
  const at = { ...HERE, heading_deg: 90 };
  const corner = (x_m: number, y_m: number) => on_earth(at, { x_m, y_m });
  const nothing: SiteDraft = { edits: [], forbidden: [] };
  it('are drawn on the earth and sent in the frame of the map', () => {
    const ring = [corner(0, 0), corner(2, 0), corner(2, 1)];
    const drawn = change_ring(0, () => ring)(add_edit('erase')(nothing));
    const polygon = [
      { x_m: 0, y_m: 0 },
      { x_m: 2, y_m: 0 },
      { x_m: 2, y_m: 1 },
    ];
    expect(change_of(drawn, map, at)).toEqual({ edits: [{ kind: 'erase', polygon }] });
    expect(distance_m(ring[0] ?? HERE, HERE)).toBeLessThan(1e-6);
  });
  it('need three corners each, and may be taken back', () => {
    const two = add_edit('wall')(add_edit('forbid')(nothing));
    expect(why_not_save(nothing, map)).toBe('Nothing is drawn.');
    const ring = [corner(0, 0), corner(1, 0), corner(1, 1)];
    const first = change_ring(0, () => ring)(two);
    expect(why_not_save(first, map)).toBe('Area 2 needs three corners.');
    expect(why_not_save(remove_edit(1)(first), map)).toBeNull();
    expect(remove_edit(7)(first)).toBe(first);
  });
  it('allow what was forbidden, and say so only then', () => {
    const [one, other] = [0, 5].map((x_m) => [
      { x_m, y_m: 0 },
      { x_m: x_m + 1, y_m: 0 },
      { x_m, y_m: 1 },
    ]);
    const forbidden = [one ?? [], other ?? []];
    const before = { ...map, forbidden };
    expect(why_not_save({ edits: [], forbidden }, before)).toBe('Nothing is drawn.');
    const left = allow(0)({ edits: [], forbidden });
    expect(why_not_save(left, before)).toBeNull();
    expect(change_of(left, before, at)).toEqual({ revision: 1, forbidden: [other], edits: [] });
  });
});

describe('a map that is being driven', () => {
  it('tells how far it is', () => {
    const making = { scans: 1, clouds: 0, way_m: 0, trouble: null };
    expect(made_so_far(making)).toBe('A map is being made: 0.0 cm driven, 1 scan.');
    expect(made_so_far({ ...making, scans: 212, way_m: 41.26 })).toBe(
      'A map is being made: 41.3 m driven, 212 scans.',
    );
    expect(made_so_far({ ...making, scans: 212, clouds: 41, way_m: 41.26 })).toBe(
      'A map is being made: 41.3 m driven, 212 scans, 41 clouds for its heights.',
    );
  });
});

describe('the place in the map', () => {
  const place: MapPlace = {
    state: 'known',
    map: 'hall',
    reason: null,
    accuracy_m: 0.034,
    heading_accuracy_deg: 0.42,
    stale: false,
  };
  it('is told with how well it is known', () => {
    expect(place_words(place)).toEqual({
      tone: 'good',
      head: 'Knows its place in “hall”',
      detail: '±3 cm, ±0.4°.',
    });
    const corridor = place_words({ ...place, accuracy_m: 3 });
    expect(corridor?.tone).toBe('warn');
    expect(corridor?.detail).toContain('every place looks alike');
  });
  it('is not told surer than it is', () => {
    expect(place_words({ ...place, accuracy_m: null })).toMatchObject({
      tone: 'warn',
      head: 'Not sure of its place in “hall”',
    });
    expect(place_words({ ...place, stale: true })?.detail).toContain('does not fit just now');
    expect(place_words({ ...place, state: 'off' })).toBeNull();
  });
  it('comes with what helps where it is not known', () => {
    const reason = 'looking for the place in the map';
    expect(place_words({ ...place, state: 'searching', reason })?.detail).toBe(
      'Looking for the place in the map. Drive some metres by hand, or say “I am here”.',
    );
    const lost = place_words({ ...place, state: 'lost' });
    expect(lost).toMatchObject({ tone: 'bad', head: 'Lost in “hall”' });
    expect(lost?.detail).toContain('by hand');
  });
  it('waits to be found where the map lies nowhere, whatever a person tells', () => {
    const nowhere = 'for nobody knows where on the earth the map lies';
    const reason = `looking for the place in the map; drive some metres by hand: a tap does not help before, ${nowhere}`;
    const searching: MapPlace = { ...place, state: 'searching', accuracy_m: null, reason };
    const detail = `L${reason.slice(1)}.`;
    expect(place_words(searching)?.detail).toBe(detail);
    expect(seen_since(searching, 1, null)?.head).toContain('the map lies nowhere yet');
    speak(() => ({ language: 'fi', texts: finnish }));
    expect(place_words(searching)?.detail).not.toContain('nobody');
    speak(() => IN_ENGLISH);
    expect(place_words({ ...place, reason: english.rb_no_anchor })?.tone).toBe('warn');
  });
  it('that a person told is seen to fit, or not', () => {
    const searching: MapPlace = { ...place, state: 'searching', accuracy_m: null };
    expect(seen_since(searching, 1, null)).toBeNull();
    expect(seen_since(searching, 6, null)?.head).toContain('does not fit there yet');
    expect(seen_since(place, 2, 0.4)?.detail).toBe('What it sees fits there, to ±3 cm.');
    expect(seen_since({ ...place, accuracy_m: null }, 1, 0)).toBeNull();
    expect(seen_since({ ...place, stale: true }, 2, 0)).toBeNull();
    expect(seen_since(place, 2, 40)).toBeNull();
    expect(seen_since(place, 6, 40)?.detail).toMatch(/40(\.0)? m from there/);
  });
});
