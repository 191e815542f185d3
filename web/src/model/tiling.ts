// The web's map tiles: which ones cover an area, and where a tile lies (Web Mercator, XYZ).

import type { LatLon } from './plan';

/** Degrees. */
export interface Bounds {
  readonly west: number;
  readonly south: number;
  readonly east: number;
  readonly north: number;
}

export interface TileAddress {
  readonly z: number;
  readonly x: number;
  readonly y: number;
}

/** Columns and rows, both ends belong to it. */
export interface TileRange {
  readonly z: number;
  readonly west: number;
  readonly east: number;
  readonly north: number;
  readonly south: number;
}

/** Beyond, the plane of the tiles ends. */
const MOST_LAT = 85.0511287798;
/** Metres on the equator that a pixel of the tile of the whole world takes. */
const WORLD_M_PER_PX = 156_543.03392804097;
const TILE_PX = 256;

const clamp = (value: number, low: number, high: number): number =>
  Math.min(Math.max(value, low), high);

/** In tiles of that zoom, with their parts. */
export const tile_point = (at: LatLon, z: number): { readonly x: number; readonly y: number } => {
  const side = 2 ** z;
  const lat = (clamp(at.lat, -MOST_LAT, MOST_LAT) * Math.PI) / 180;
  return {
    x: ((at.lon + 180) / 360) * side,
    y: ((1 - Math.asinh(Math.tan(lat)) / Math.PI) / 2) * side,
  };
};

/** The other way around. */
export const place_at = (x: number, y: number, z: number): LatLon => {
  const side = 2 ** z;
  return {
    lat: (Math.atan(Math.sinh(Math.PI * (1 - (2 * y) / side))) * 180) / Math.PI,
    lon: (x / side) * 360 - 180,
  };
};

export const tiles_across = (bounds: Bounds, z: number): TileRange => {
  const last = 2 ** z - 1;
  const a = tile_point({ lat: bounds.north, lon: bounds.west }, z);
  const b = tile_point({ lat: bounds.south, lon: bounds.east }, z);
  const whole = (value: number): number => clamp(Math.floor(value), 0, last);
  return { z, west: whole(a.x), north: whole(a.y), east: whole(b.x), south: whole(b.y) };
};

export const count_of = ({ west, east, north, south }: TileRange): number =>
  (east - west + 1) * (south - north + 1);

export const count_tiles = (bounds: Bounds, from: number, to: number): number => {
  let count = 0;
  for (let z = from; z <= to; z++) count += count_of(tiles_across(bounds, z));
  return count;
};

/** The coarse ones first: what was kept when it was given up is of use. */
export function* tiles_of(bounds: Bounds, from: number, to: number): Generator<TileAddress> {
  for (let z = from; z <= to; z++) {
    const range = tiles_across(bounds, z);
    for (let y = range.north; y <= range.south; y++) {
      for (let x = range.west; x <= range.east; x++) yield { z, x, y };
    }
  }
}

/** Metres on the ground that a pixel of a tile shows. */
export const pixel_m = (lat: number, z: number): number =>
  (WORLD_M_PER_PX * Math.cos((lat * Math.PI) / 180)) / 2 ** z;

/** The zoom at which no detail of a picture is lost. @param m_per_px on the ground */
export const zoom_for = (m_per_px: number, lat: number, most: number): number => {
  return clamp(Math.ceil(Math.log2(pixel_m(lat, 0) / m_per_px) - 0.25), 0, most);
};

/** The address of a tile. @param template with {z}, {x} and {y}, or {-y}: rows from the south */
export const tile_url = (template: string, { z, x, y }: TileAddress): string =>
  template
    .replaceAll('{z}', String(z))
    .replaceAll('{x}', String(x))
    .replaceAll('{y}', String(y))
    .replaceAll('{-y}', String(2 ** z - 1 - y));

export { TILE_PX };
