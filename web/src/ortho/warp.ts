// From a tile's pixels to those of the picture: exact at a lattice of points, straight between them.

import { place_at, TILE_PX, type TileAddress } from '../model/tiling';

/** Where a place lies in the picture: columns and rows from its upper left corner. */
export type ToPicture = (lon: number, lat: number) => readonly [x: number, y: number];

/** Metres or degrees of the picture's plane to its pixels: x = a·px + b·py + c, y = d·px + e·py + f. */
export interface Affine {
  readonly a: number;
  readonly b: number;
  readonly c: number;
  readonly d: number;
  readonly e: number;
  readonly f: number;
}

/** @return empty: it maps the picture onto a line */
export const to_pixels = ({
  a,
  b,
  c,
  d,
  e,
  f,
}: Affine): ((x: number, y: number) => readonly [number, number]) | null => {
  const determinant = a * e - b * d;
  if (!Number.isFinite(determinant) || determinant === 0) return null;
  return (x, y) => [
    (e * (x - c) - b * (y - f)) / determinant,
    (a * (y - f) - d * (x - c)) / determinant,
  ];
};

const STEP_PX = 16;
const NODES = TILE_PX / STEP_PX + 1;

export interface Lattice {
  readonly xs: Float64Array;
  readonly ys: Float64Array;
}

export const lattice_of = ({ z, x, y }: TileAddress, to_picture: ToPicture): Lattice => {
  const xs = new Float64Array(NODES * NODES);
  const ys = new Float64Array(NODES * NODES);
  for (let row = 0; row < NODES; row++) {
    for (let column = 0; column < NODES; column++) {
      const at = place_at(x + (column * STEP_PX) / TILE_PX, y + (row * STEP_PX) / TILE_PX, z);
      const [px, py] = to_picture(at.lon, at.lat);
      xs[row * NODES + column] = px;
      ys[row * NODES + column] = py;
    }
  }
  return { xs, ys };
};

export interface PictureWindow {
  readonly left: number;
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
}

/** What of the picture the tile shows, with a pixel around; null: nothing. */
export const window_of = (
  { xs, ys }: Lattice,
  width: number,
  height: number,
): PictureWindow | null => {
  const left = Math.max(0, Math.floor(Math.min(...xs)) - 1);
  const top = Math.max(0, Math.floor(Math.min(...ys)) - 1);
  const right = Math.min(width, Math.ceil(Math.max(...xs)) + 1);
  const bottom = Math.min(height, Math.ceil(Math.max(...ys)) + 1);
  return left < right && top < bottom ? { left, top, right, bottom } : null;
};

const between = (grid: Float64Array, column: number, row: number): number => {
  const k = Math.min(Math.floor(row), NODES - 2) * NODES + Math.min(Math.floor(column), NODES - 2);
  const u = column - (k % NODES);
  const v = row - Math.floor(k / NODES);
  const top = (grid[k] ?? 0) * (1 - u) + (grid[k + 1] ?? 0) * u;
  const bottom = (grid[k + NODES] ?? 0) * (1 - u) + (grid[k + NODES + 1] ?? 0) * u;
  return top * (1 - v) + bottom * v;
};

/** Red, green, blue and how opaque, of a window of the picture. */
export interface Pixels {
  readonly window: PictureWindow;
  readonly rgba: Uint8ClampedArray;
}

/** The tile's own pixels. What lies beyond the picture stays clear. @return false: all of it is */
export const warp = (lattice: Lattice, from: Pixels, into: Uint8ClampedArray): boolean => {
  const { left, top, right, bottom } = from.window;
  const width = right - left;
  let seen = false;
  for (let row = 0; row < TILE_PX; row++) {
    for (let column = 0; column < TILE_PX; column++) {
      const u = (column + 0.5) / STEP_PX;
      const v = (row + 0.5) / STEP_PX;
      const px = Math.floor(between(lattice.xs, u, v));
      const py = Math.floor(between(lattice.ys, u, v));
      if (px < left || px >= right || py < top || py >= bottom) continue;
      const source = 4 * ((py - top) * width + (px - left));
      const target = 4 * (row * TILE_PX + column);
      for (let k = 0; k < 4; k++) into[target + k] = from.rgba[source + k] ?? 0;
      seen ||= (from.rgba[source + 3] ?? 0) > 0;
    }
  }
  return seen;
};
