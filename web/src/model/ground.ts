// The ground pictures of the map: the robot's sets, those of the network, which one is shown, and
// how far it is moved.

import type { Answer } from './answer';
import { metres } from './format';
import { distance_m, offset_between } from './geo';
import type { LatLon } from './plan';
import { say } from './say';
import type { Bounds, TileAddress } from './tiling';

export type TileFormat = 'png' | 'jpg' | 'webp' | 'pbf';

export interface TileSet {
  readonly set: string;
  readonly name: string;
  readonly format: TileFormat;
  readonly min_zoom: number;
  readonly max_zoom: number;
  /** West, south, east, north; null: it has no tile yet. */
  readonly bounds: readonly number[] | null;
  readonly attribution: string;
  /** It may be deleted. */
  readonly kept: boolean;
  readonly grows: boolean;
  /** East and north. */
  readonly shift_m: readonly number[];
  readonly bytes: number;
}

export interface OnlineTiles {
  readonly name: string;
  readonly url: string;
  readonly attribution: string;
  readonly max_zoom: number;
}

export interface TileShelf {
  readonly items: readonly TileSet[];
  readonly unfinished: readonly { readonly set: string; readonly received_bytes: number }[];
  readonly online: readonly OnlineTiles[];
}

export interface NewTileSet {
  readonly set: string;
  readonly name: string;
  readonly format: TileFormat;
  readonly attribution?: string;
}

export interface TileCalls {
  list(): Promise<Answer<TileShelf>>;
  create(set: NewTileSet): Promise<Answer<TileSet>>;
  put(set: string, at: TileAddress, picture: Blob): Promise<Answer<null>>;
  /** The next piece of a file. @return the set once it is whole; null: more is awaited */
  send(set: string, offset: number, size: number, piece: Blob): Promise<Answer<TileSet | null>>;
  change(
    set: string,
    change: { readonly name?: string; readonly shift_m?: readonly number[] },
  ): Promise<Answer<TileSet>>;
  remove(set: string): Promise<Answer<null>>;
  /** A tile of the network; null: there is none. */
  fetch(url: string): Promise<Answer<Blob | null>>;
}

/** What the map shows beneath everything. */
export interface Ground {
  readonly url: string;
  readonly vector: boolean;
  readonly min_zoom: number;
  readonly max_zoom: number;
  readonly bounds: Bounds | null;
  readonly attribution: string;
  readonly shift_m: readonly [east: number, north: number];
}

/** Kept on this device: "set:farm", "online:aerial", "none"; empty: nobody chose. */
export type GroundChoice = string;

export const bounds_of = (set: TileSet): Bounds | null => {
  const [west, south, east, north] = set.bounds ?? [];
  return west === undefined || south === undefined || east === undefined || north === undefined
    ? null
    : { west, south, east, north };
};

const of_set = (set: TileSet): Ground => ({
  url: `/api/v1/tiles/${encodeURIComponent(set.set)}/{z}/{x}/{y}`,
  vector: set.format === 'pbf',
  min_zoom: set.min_zoom,
  max_zoom: set.max_zoom,
  bounds: bounds_of(set),
  attribution: set.attribution,
  shift_m: [set.shift_m[0] ?? 0, set.shift_m[1] ?? 0],
});

/** Nobody chose: the first set that is a picture, else the first. What is gone is not shown. */
export const chosen_set = (shelf: TileShelf, choice: GroundChoice): TileSet | null => {
  if (choice !== '') return shelf.items.find(({ set }) => choice === `set:${set}`) ?? null;
  const filled = shelf.items.filter(({ bounds }) => bounds !== null);
  return filled.find(({ format }) => format !== 'pbf') ?? filled[0] ?? null;
};

export const chosen_online = (shelf: TileShelf, choice: GroundChoice): OnlineTiles | null =>
  shelf.online.find(({ name }) => choice === `online:${name}`) ?? null;

export const ground_of = (shelf: TileShelf, choice: GroundChoice): Ground | null => {
  const online = chosen_online(shelf, choice);
  if (online) {
    const { url, max_zoom, attribution } = online;
    return {
      url,
      max_zoom,
      attribution,
      min_zoom: 0,
      vector: false,
      bounds: null,
      shift_m: [0, 0],
    };
  }
  const set = chosen_set(shelf, choice);
  return set && of_set(set);
};

/** A name for the address: "Käo põld 2024.tif" is "kao-pold-2024". */
export const set_name = (name: string, taken: readonly string[]): string => {
  const plain = name
    .replace(/\.[a-z0-9]+$/i, '')
    .normalize('NFD')
    .replace(/\p{M}/gu, '')
    .toLowerCase()
    .replace(/[^a-z0-9_]+/g, '-')
    .replace(/^-+|-+$/g, '')
    .slice(0, 36);
  const base = plain === '' ? 'map' : plain;
  for (let n = 1; ; n++) {
    const wanted = n === 1 ? base : `${base}-${n}`;
    if (!taken.includes(wanted)) return wanted;
  }
};

/** How it is to be moved so that what is shown at one place lies at another. */
export const moved_shift = (
  shift_m: readonly number[],
  shown: LatLon,
  there: LatLon,
): readonly [east: number, north: number] => {
  const { east_m, north_m } = offset_between(shown, there);
  const cm = (metres: number): number => Math.round(metres * 100) / 100;
  return [cm((shift_m[0] ?? 0) + east_m), cm((shift_m[1] ?? 0) + north_m)];
};

/** SQLite's own first bytes, or those of a TIFF (also of a big one). */
export type GroundFile = 'mbtiles' | 'geotiff' | null;
export const kind_of_file = (head: Uint8Array): GroundFile => {
  const text = String.fromCharCode(...head.slice(0, 16));
  if (text.startsWith('SQLite format 3')) return 'mbtiles';
  if (head.length < 4) return null;
  const mark = `${text.slice(0, 2)}${head[2] ?? 0},${head[3] ?? 0}`;
  return ['II42,0', 'II43,0', 'MM0,42', 'MM0,43'].includes(mark) ? 'geotiff' : null;
};

/** Tiles of an area that may be kept at once: half a gigabyte, about. */
export const MOST_TILES = 20_000;
/** Of an aerial picture. */
export const USUAL_TILE_BYTES = 20_000;

const FAR_M = 1000;

/** Of a picture that shows nothing near the robot: how far away it begins. @param bounds west,
 * south, east, north @param robot null: nobody knows where it is @return null: it is near */
export const away_words = (bounds: readonly number[], robot: LatLon | null): string | null => {
  const [west = 0, south = 0, east = 0, north = 0] = bounds;
  if (!robot) return null;
  const nearest = {
    lat: Math.min(Math.max(robot.lat, south), north),
    lon: Math.min(Math.max(robot.lon, west), east),
  };
  const far_m = distance_m(robot, nearest);
  return far_m > FAR_M ? say('ground_far', { far: metres(far_m) }) : null;
};
