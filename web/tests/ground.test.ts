import { describe, expect, it } from 'vitest';

import { offset_from } from '../src/model/geo';
import {
  away_words,
  ground_of,
  kind_of_file,
  moved_shift,
  set_name,
  type TileSet,
  type TileShelf,
} from '../src/model/ground';

const set = (name: string, more: Partial<TileSet> = {}): TileSet => ({
  set: name,
  name,
  format: 'png',
  min_zoom: 10,
  max_zoom: 20,
  bounds: [26, 58, 27, 59],
  attribution: 'Board',
  kept: true,
  grows: false,
  shift_m: [0, 0],
  bytes: 1,
  ...more,
});
const shelf: TileShelf = {
  items: [set('empty', { bounds: null }), set('roads', { format: 'pbf' }), set('farm')],
  unfinished: [],
  online: [{ name: 'aerial', url: 'https://a/{z}/{x}/{y}', attribution: 'B', max_zoom: 19 }],
};

describe('the ground that is shown', () => {
  it('is the first picture until somebody chooses', () => {
    expect(ground_of(shelf, '')?.url).toContain('/tiles/farm/');
    expect(ground_of(shelf, 'none')).toBeNull();
    expect(ground_of(shelf, 'set:roads')?.vector).toBe(true);
    expect(ground_of(shelf, 'online:aerial')?.url).toBe('https://a/{z}/{x}/{y}');
  });

  it('is none where what was chosen is gone', () => {
    expect(ground_of(shelf, 'set:sold')).toBeNull();
    expect(ground_of({ items: [], unfinished: [], online: [] }, '')).toBeNull();
  });
});

describe('a file of the ground', () => {
  it('is known by its first bytes, whatever it is called', () => {
    const bytes = (text: string): Uint8Array => new TextEncoder().encode(text);
    expect(kind_of_file(bytes('SQLite format 3\0'))).toBe('mbtiles');
    expect(kind_of_file(new Uint8Array([0x49, 0x49, 42, 0, 8]))).toBe('geotiff');
    expect(kind_of_file(new Uint8Array([0x4d, 0x4d, 0, 42]))).toBe('geotiff');
    expect(kind_of_file(new Uint8Array([0x49, 0x49, 43, 0]))).toBe('geotiff'); // a big one
    expect(kind_of_file(bytes('II*'))).toBeNull();
    expect(kind_of_file(bytes('<gpx>'))).toBeNull();
    expect(kind_of_file(new Uint8Array())).toBeNull();
  });

  it('gets a name that goes into an address, and is not taken', () => {
    expect(set_name('Käo põld 2024.tif', [])).toBe('kao-pold-2024');
    expect(set_name('farm.mbtiles', ['farm', 'farm-2'])).toBe('farm-3');
    expect(set_name('поле.tif', [])).toBe('map');
    expect(set_name(`${'a'.repeat(80)}.tif`, [])).toMatch(/^a{36}$/);
  });
});

it('is moved by as much as it lies beside the robot', () => {
  const mark = { lat: 58.378, lon: 26.729 };
  const robot = offset_from(mark, { east_m: 1.5, north_m: -0.75 });
  expect(moved_shift([0, 0], mark, robot)).toEqual([1.5, -0.75]);
  // What was moved before is moved further.
  expect(moved_shift([0.25, 1], mark, robot)).toEqual([1.75, 0.25]);
});

describe('a picture that lies elsewhere', () => {
  const bounds = [26, 58, 27, 59];
  it('is said with how far away it begins', () => {
    // One degree of latitude south of it: 111 km.
    expect(away_words(bounds, { lat: 57, lon: 26.5 })).toBe('111 km from the robot');
  });
  it('is not said of one that the robot stands in, or beside', () => {
    expect(away_words(bounds, { lat: 58.5, lon: 26.5 })).toBeNull();
    expect(away_words(bounds, { lat: 57.995, lon: 26.5 })).toBeNull();
    expect(away_words(bounds, null)).toBeNull();
  });
});
