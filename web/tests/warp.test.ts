import { expect, it } from 'vitest';

import { lattice_of, to_pixels, warp, window_of } from '../src/ortho/warp';
import { place_at, TILE_PX } from '../src/model/tiling';

const TILE = { z: 18, x: 150_535, y: 78_789 };

/** A picture of a plane in degrees that covers the tile's middle half, 64 by 64 pixels. */
const corner = place_at(TILE.x + 0.25, TILE.y + 0.25, TILE.z);
const far = place_at(TILE.x + 0.75, TILE.y + 0.75, TILE.z);
const to_picture = (lon: number, lat: number): readonly [number, number] => [
  ((lon - corner.lon) / (far.lon - corner.lon)) * 64,
  ((lat - corner.lat) / (far.lat - corner.lat)) * 64,
];

it('takes each pixel from where it lies in the picture', () => {
  const lattice = lattice_of(TILE, to_picture);
  const window = window_of(lattice, 64, 64);
  expect(window).toEqual({ left: 0, top: 0, right: 64, bottom: 64 });
  // Each pixel of the picture has its own column and row as colours.
  const rgba = new Uint8ClampedArray(4 * 64 * 64);
  for (let y = 0; y < 64; y++) {
    for (let x = 0; x < 64; x++) rgba.set([x, y, 7, 255], 4 * (64 * y + x));
  }
  const into = new Uint8ClampedArray(4 * TILE_PX * TILE_PX);
  if (!window) throw new Error('nothing is shown');
  expect(warp(lattice, { window, rgba }, into)).toBe(true);
  const at = (x: number, y: number): number[] => [
    ...into.slice(4 * (256 * y + x), 4 * (256 * y + x) + 4),
  ];
  expect(at(63, 128)).toEqual([0, 0, 0, 0]);
  expect(at(64, 64)).toEqual([0, 0, 7, 255]);
  expect(at(128, 129)).toEqual([32, 32, 7, 255]);
  expect(at(191, 191)).toEqual([63, 63, 7, 255]);
  expect(at(192, 100)).toEqual([0, 0, 0, 0]);
});

it('shows nothing of a picture that lies elsewhere', () => {
  expect(window_of(lattice_of({ ...TILE, x: TILE.x + 1 }, to_picture), 64, 64)).toBeNull();
});

it('finds the pixel of a turned picture, and none where it is a line', () => {
  // Turned by 90 degrees, half a metre a pixel: east is down.
  const pixels = to_pixels({ a: 0, b: 0.5, c: 500_000, d: 0.5, e: 0, f: 6_470_000 });
  expect(pixels?.(500_010, 6_470_003)).toEqual([6, 20]);
  expect(to_pixels({ a: 1, b: 2, c: 0, d: 2, e: 4, f: 0 })).toBeNull();
});
