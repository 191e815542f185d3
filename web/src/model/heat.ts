// Several runs as one picture: squares of the ground, by how often they were driven over and how far
// off the path.

import { offset_between, offset_from } from './geo';
import type { LatLon } from './plan';
import type { RunTrack } from './run_track';

export interface HeatCell extends LatLon {
  /** Runs that came over it. */
  readonly runs: number;
  /** Mean distance from the path there, metres; null: no run tells. */
  readonly off_m: number | null;
}
export interface Heat {
  /** Side of a cell, metres; its place is its middle. */
  readonly cell_m: number;
  readonly cells: readonly HeatCell[];
}

/** As many as a phone draws in a frame. */
const MOST_CELLS = 20_000;
const SMALLEST_M = 0.25;
const COLUMNS = 2 ** 24;

interface Sum {
  readonly runs: Set<number>;
  off_m: number;
  told: number;
}

/** Steps of half a cell, so that who drives fast leaves no gaps. */
const walk = (
  track: RunTrack,
  origin: LatLon,
  cell_m: number,
  visit: (column: number, row: number, off_m: number) => boolean,
): boolean => {
  const begins = new Set(track.begins);
  let last: { east_m: number; north_m: number } | null = null;
  for (let k = 0; k < track.size; k += 1) {
    const here = offset_between(origin, { lat: track.lat[k] ?? 0, lon: track.lon[k] ?? 0 });
    const from: { east_m: number; north_m: number } = last && !begins.has(k) ? last : here;
    const length_m = Math.hypot(here.east_m - from.east_m, here.north_m - from.north_m);
    const steps = Math.max(1, Math.ceil((2 * length_m) / cell_m));
    for (let i = 1; i <= steps; i += 1) {
      const east_m = from.east_m + ((here.east_m - from.east_m) * i) / steps;
      const north_m = from.north_m + ((here.north_m - from.north_m) * i) / steps;
      const off_m = Math.abs(track.cross_track_m[k] ?? Number.NaN);
      if (!visit(Math.floor(east_m / cell_m), Math.floor(north_m / cell_m), off_m)) return false;
    }
    last = here;
  }
  return true;
};

const sums_of = (
  tracks: readonly RunTrack[],
  origin: LatLon,
  cell_m: number,
): Map<number, Sum> | null => {
  const sums = new Map<number, Sum>();
  const within = tracks.every((track, run) =>
    walk(track, origin, cell_m, (column, row, off_m) => {
      const key = row * COLUMNS + column;
      let sum = sums.get(key);
      if (!sum) {
        if (sums.size === MOST_CELLS) return false;
        sum = { runs: new Set(), off_m: 0, told: 0 };
        sums.set(key, sum);
      }
      sum.runs.add(run);
      if (!Number.isNaN(off_m)) {
        sum.off_m += off_m;
        sum.told += 1;
      }
      return true;
    }),
  );
  return within ? sums : null;
};

/** Cells grow until there are few enough. */
export const heat_of = (tracks: readonly RunTrack[]): Heat => {
  const first = tracks.find(({ size }) => size > 0);
  if (!first) return { cell_m: SMALLEST_M, cells: [] };
  const origin = { lat: first.lat[0] ?? 0, lon: first.lon[0] ?? 0 };
  let cell_m = SMALLEST_M;
  let sums = sums_of(tracks, origin, cell_m);
  while (!sums) {
    cell_m *= 2;
    sums = sums_of(tracks, origin, cell_m);
  }
  const cells = [...sums].map(([key, { runs, off_m, told }]): HeatCell => {
    const row = Math.round(key / COLUMNS);
    const column = key - row * COLUMNS;
    const middle = { east_m: (column + 0.5) * cell_m, north_m: (row + 0.5) * cell_m };
    return {
      ...offset_from(origin, middle),
      runs: runs.size,
      off_m: told > 0 ? off_m / told : null,
    };
  });
  return { cell_m, cells };
};
