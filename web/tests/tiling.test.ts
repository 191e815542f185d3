// Tiles of an area, as an independent figure tells: a tile of zoom 18 at 58.4° N is 80 m wide.

import { describe, expect, it } from 'vitest';

import {
  count_tiles,
  pixel_m,
  place_at,
  tile_point,
  tile_url,
  tiles_across,
  tiles_of,
  zoom_for,
} from '../src/model/tiling';

// Tartu; its tile of zoom 16 by the formula of the slippy map.
const TARTU = { lat: 58.378, lon: 26.729 };

describe('tiles of the web', () => {
  it('lie where everybody else has them', () => {
    const { x, y } = tile_point(TARTU, 16);
    expect([Math.floor(x), Math.floor(y)]).toEqual([37633, 19608]);
    const back = place_at(x, y, 16);
    expect(back.lat).toBeCloseTo(TARTU.lat, 9);
    expect(back.lon).toBeCloseTo(TARTU.lon, 9);
    expect(tile_point({ lat: 0, lon: 0 }, 0)).toEqual({ x: 0.5, y: 0.5 });
    expect(place_at(0, 0, 3).lat).toBeCloseTo(85.0511287798, 6);
  });

  it('show 31 cm of the ground with a pixel of zoom 18 at 58.4° N', () => {
    expect(256 * pixel_m(58.4, 18)).toBeCloseTo(80, 0);
    expect(pixel_m(0, 0)).toBeCloseTo(156_543, 0);
  });

  it('cover an area, its edges too, and no more', () => {
    const bounds = { west: 26.72, east: 26.74, south: 58.37, north: 58.38 };
    const range = tiles_across(bounds, 16);
    expect(range).toEqual({ z: 16, west: 37632, east: 37635, north: 19607, south: 19611 });
    expect(count_tiles(bounds, 16, 16)).toBe(20);
    const all = [...tiles_of(bounds, 15, 16)];
    expect(all).toHaveLength(count_tiles(bounds, 15, 16));
    expect(all[0]?.z).toBe(15);
    expect(count_tiles({ west: -180, east: 180, south: -90, north: 90 }, 0, 2)).toBe(1 + 4 + 16);
  });

  it('are as fine as the picture', () => {
    // 0.1 m a pixel at 58.4° N: zoom 19 has 0.156 m, zoom 20 has 0.078 m.
    expect(zoom_for(0.1, 58.4, 24)).toBe(20);
    expect(zoom_for(0.156, 58.4, 24)).toBe(19);
    expect(zoom_for(1e-9, 58.4, 24)).toBe(24);
    expect(zoom_for(1e9, 58.4, 24)).toBe(0);
  });

  it('have the address that a template says', () => {
    expect(tile_url('https://a/{z}/{x}/{y}.png', { z: 3, x: 5, y: 6 })).toBe('https://a/3/5/6.png');
    expect(tile_url('https://a?TILEROW={y}&TILECOL={x}&m={z}', { z: 3, x: 5, y: 6 })).toBe(
      'https://a?TILEROW=6&TILECOL=5&m=3',
    );
    expect(tile_url('https://a/{z}/{x}/{-y}', { z: 3, x: 5, y: 6 })).toBe('https://a/3/5/1');
  });
});
