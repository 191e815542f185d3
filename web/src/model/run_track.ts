// The track of a run in columns, as the table that the robot keeps of it, and what is made of it for
// the map: lines that do not join over a jump, shades by deviation or speed, the place at a moment.

import { shortest } from './figures';
import { distance_m } from './geo';
import type { LatLon } from './plan';
import { say } from './say';
import { shown_per, shown_unit, type SpeedUnit } from './settings';

const COLUMNS = [
  't_s',
  'lat',
  'lon',
  'heading_deg',
  'speed_mps',
  'accuracy_m',
  'cross_track_m',
  'power_w',
  'item',
  'lap',
] as const;
type Column = (typeof COLUMNS)[number];

/** Oldest first; NaN where it is not known. */
export interface RunTrack extends Readonly<Record<Column, Float64Array>> {
  readonly size: number;
  /** Driven since the begin, metres; a jump of the position is no way. */
  readonly way_m: Float64Array;
  /** First points of what a line may join. */
  readonly begins: readonly number[];
}

/** Farther between two samples than this robot can have come: the position jumped. */
const reach_m = (speed_mps: number, dt_s: number): number =>
  2 + 2 * Math.abs(Number.isNaN(speed_mps) ? 0 : speed_mps) * Math.max(0, dt_s);

const with_way = (size: number, columns: Record<Column, Float64Array>): RunTrack => {
  const { t_s, lat, lon, speed_mps, lap } = columns;
  const at = (k: number): LatLon => ({ lat: lat[k] ?? 0, lon: lon[k] ?? 0 });
  const way_m = new Float64Array(size);
  const begins: number[] = size > 0 ? [0] : [];
  for (let k = 1; k < size; k += 1) {
    const moved_m = distance_m(at(k - 1), at(k));
    const jumped = moved_m > reach_m(speed_mps[k] ?? 0, (t_s[k] ?? 0) - (t_s[k - 1] ?? 0));
    way_m[k] = (way_m[k - 1] ?? 0) + (jumped ? 0 : moved_m);
    if (jumped || lap[k] !== lap[k - 1]) begins.push(k);
  }
  return { ...columns, size, way_m, begins };
};

/** @param text `GET /runs/{id}/track?format=csv` @return null: that is no such table */
export const track_of_csv = (text: string): RunTrack | null => {
  const lines = text.split('\n');
  const names = (lines[0] ?? '').trim().split(',');
  const places = COLUMNS.map((name) => names.indexOf(name));
  if (places.slice(0, 3).some((place) => place < 0)) return null;
  const rows = lines.slice(1).filter((line) => line !== '');
  const columns = Object.fromEntries(
    COLUMNS.map((name) => [name, new Float64Array(rows.length)]),
  ) as Record<Column, Float64Array>;
  rows.forEach((row, k) => {
    const cells = row.split(',');
    COLUMNS.forEach((name, c) => {
      const cell = cells[places[c] ?? -1] ?? '';
      columns[name][k] = cell === '' ? Number.NaN : Number(cell);
    });
  });
  return with_way(rows.length, columns);
};

/** The last sample that is not behind `x`; the first one before all; -1 in an empty track. */
export const index_at = (column: Float64Array, x: number): number => {
  let low = 0;
  let high = column.length - 1;
  if (high < 0) return -1;
  while (low < high) {
    const middle = Math.ceil((low + high) / 2);
    if ((column[middle] ?? 0) <= x) low = middle;
    else high = middle - 1;
  }
  return low;
};

export const lines_of = (track: RunTrack): readonly (readonly LatLon[])[] =>
  track.begins.map((first, k) => {
    const end = track.begins[k + 1] ?? track.size;
    return Array.from({ length: end - first }, (_, i) => ({
      lat: track.lat[first + i] ?? 0,
      lon: track.lon[first + i] ?? 0,
    }));
  });

/** What the driven line's colour tells. */
export type ShadeBy = 'run' | 'deviation' | 'speed';

export interface Shades {
  /** Upper ends of all shades but the last, which has none. */
  readonly limits: readonly number[];
  readonly unit: 'm' | 'm/s';
  /** For each point of each line the number of its shade, from 0; 255: not known. */
  readonly of: readonly Uint8Array[];
}

export const UNKNOWN_SHADE = 255;
/** Metres off the path: what RTK keeps, a good one, a hand, two, a wheel's width. */
const DEVIATION_M = [0.02, 0.05, 0.1, 0.2, 0.5] as const;
/** Of several runs in one picture, in the order of their shades. */
export const HEAT_LIMITS_M: readonly number[] = DEVIATION_M;
const SPEED_SHARES = [0.2, 0.4, 0.6, 0.8, 0.95] as const;

export const shade_of = (value: number, limits: readonly number[]): number => {
  if (Number.isNaN(value)) return UNKNOWN_SHADE;
  const k = limits.findIndex((limit) => value <= limit);
  return k < 0 ? limits.length : k;
};

const two_digits = (value: number): number => Math.round(value * 100) / 100;

export const shades_of = (track: RunTrack, by: 'deviation' | 'speed'): Shades => {
  const speed = by === 'speed';
  const column = speed ? track.speed_mps : track.cross_track_m;
  const fastest = track.speed_mps.reduce((most, v) => Math.max(most, Math.abs(v) || 0), 0);
  const limits = speed ? SPEED_SHARES.map((share) => two_digits(share * fastest)) : DEVIATION_M;
  const of = track.begins.map((first, k) =>
    Uint8Array.from(column.subarray(first, track.begins[k + 1] ?? track.size), (value) =>
      shade_of(Math.abs(value), limits),
    ),
  );
  return { limits, unit: speed ? 'm/s' : 'm', of };
};

/** "to 2 cm", "to 5 cm" … "more", in the order of the shades. */
export const shade_words = ({ limits, unit }: Shades, speed: SpeedUnit = 'm/s'): string[] => {
  const in_cm = unit === 'm';
  const per = in_cm ? 100 : shown_per(unit, speed);
  const shown = in_cm ? 'cm' : shown_unit(unit, speed);
  return [
    ...limits.map((limit) =>
      say('to_limit_unit', { limit: shortest(limit * per, 2), unit: shown }),
    ),
    say('word_more'),
  ];
};

export const heat_words = (): string[] => shade_words({ limits: HEAT_LIMITS_M, unit: 'm', of: [] });

/** What the plots lie over. */
export type Axis = 'time' | 'way';

export const axis_of = (track: RunTrack, axis: Axis): Float64Array =>
  axis === 'time' ? track.t_s : track.way_m;

export interface Moment extends LatLon {
  readonly heading_deg: number | null;
  readonly t_s: number;
  readonly way_m: number;
  readonly speed_mps: number | null;
  readonly cross_track_m: number | null;
  readonly accuracy_m: number | null;
  readonly item: number | null;
}

const known = (value: number | undefined): number | null =>
  value === undefined || Number.isNaN(value) ? null : value;

/** @return null: the run has no track */
export const moment_at = (track: RunTrack, axis: Axis, x: number): Moment | null => {
  const k = index_at(axis_of(track, axis), x);
  if (k < 0) return null;
  return {
    lat: track.lat[k] ?? 0,
    lon: track.lon[k] ?? 0,
    heading_deg: known(track.heading_deg[k]),
    t_s: track.t_s[k] ?? 0,
    way_m: track.way_m[k] ?? 0,
    speed_mps: known(track.speed_mps[k]),
    cross_track_m: known(track.cross_track_m[k]),
    accuracy_m: known(track.accuracy_m[k]),
    item: known(track.item[k]),
  };
};

/** Where an event of a run stands on an axis. @param begun, time RFC 3339 */
export const event_place = (track: RunTrack, axis: Axis, begun: string, time: string): number => {
  const t_s = (Date.parse(time) - Date.parse(begun)) / 1000;
  if (axis === 'time') return t_s;
  return track.way_m[index_at(track.t_s, t_s)] ?? 0;
};
