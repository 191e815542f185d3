// Where on earth a row of a file lies, read from the file itself: what was left out has no item that
// would tell. Only what the row says beyond doubt is taken; a row with two places, or in a form that
// is not known here, has none.

import { is_record, json_of } from './checked';
import type { LatLon } from './plan';

const place = (lat: unknown, lon: unknown): LatLon | null =>
  typeof lat === 'number' &&
  typeof lon === 'number' &&
  Math.abs(lat) <= 90 &&
  Math.abs(lon) <= 180 &&
  !(lat === 0 && lon === 0) // "where the vehicle is"
    ? { lat, lon }
    : null;

/** RFC 6901. */
const at_pointer = (whole: unknown, pointer: string): unknown => {
  let value = whole;
  for (const part of pointer.split('/').slice(1)) {
    const key = part.replaceAll('~1', '/').replaceAll('~0', '~');
    if (Array.isArray(value)) value = value[Number(key)] as unknown;
    else value = is_record(value) ? value[key] : undefined;
  }
  return value;
};

/** A pair of numbers, or lists of them. @param geo [lon, lat], as GeoJSON has it; else [lat, lon] */
const pairs = (value: unknown, geo: boolean): LatLon[] => {
  if (!Array.isArray(value)) return [];
  const [first, second] = value as readonly unknown[];
  if (typeof first !== 'number') return value.flatMap((part: unknown) => pairs(part, geo));
  const at = geo ? place(second, first) : place(first, second);
  return at ? [at] : [];
};

/** Of a feature or geometry of GeoJSON; of an item, a polygon or a circle of QGroundControl. */
const places_of_value = (value: unknown, geo: boolean): LatLon[] => {
  if (!is_record(value)) return pairs(value, geo);
  if (is_record(value['geometry'])) return places_of_value(value['geometry'], true);
  if (Array.isArray(value['geometries'])) {
    return value['geometries'].flatMap((part: unknown) => places_of_value(part, true));
  }
  if (value['coordinates'] !== undefined) return pairs(value['coordinates'], true);
  if (is_record(value['circle'])) return pairs(value['circle']['center'], false);
  const { params } = value;
  if (Array.isArray(params)) return pairs(params.slice(4, 6), false);
  return pairs(value['coordinate'] ?? value['polygon'], false);
};

const NUMBER = String.raw`-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?`;
const ATTRIBUTES = [/\blat\s*=\s*["']([^"']+)["']/g, /\blon\s*=\s*["']([^"']+)["']/g] as const;
const LON_LAT = new RegExp(`(${NUMBER}),(${NUMBER})(?:,${NUMBER})?(?=[\\s<]|$)`, 'g');

/** What a line holds exactly once. */
const only = (line: string, pattern: RegExp): RegExpMatchArray | null => {
  const [first, ...more] = line.matchAll(pattern);
  return first && more.length === 0 ? first : null;
};

const place_of_line = (line: string, format: string): LatLon | null => {
  switch (format) {
    case 'waypoints': {
      const columns = line.trim().split(/\s+/);
      return columns.length === 12 ? place(Number(columns[8]), Number(columns[9])) : null;
    }
    case 'gpx': {
      const [lat, lon] = ATTRIBUTES.map((name) => only(line, name)?.[1]);
      return place(Number(lat), Number(lon));
    }
    case 'kml': {
      const found = only(line, LON_LAT);
      return found ? place(Number(found[2]), Number(found[1])) : null;
    }
    default:
      return null;
  }
};

/** @param row "line 3", or a JSON pointer @return none: it says none */
export type PlacesOfRow = (row: string) => readonly LatLon[];

export const NO_PLACES: PlacesOfRow = () => [];

/** @param format as the robot found it: plan, waypoints … */
export const places_in_file = (text: string, format: string): PlacesOfRow => {
  if (format === 'plan' || format === 'geojson') {
    const whole = json_of(text);
    return (row) =>
      row.startsWith('/') ? places_of_value(at_pointer(whole, row), format === 'geojson') : [];
  }
  const lines = text.split(/\r\n|\r|\n/);
  return (row) => {
    const [, number] = /^line (\d+)$/.exec(row) ?? [];
    const line = number === undefined ? undefined : lines[Number(number) - 1];
    const at = line === undefined ? null : place_of_line(line, format);
    return at ? [at] : [];
  };
};
