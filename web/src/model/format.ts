// Numbers as people read them. Null, undefined and NaN are "—".

import type { LatLon } from './plan';

type Value = number | null | undefined;

export const UNKNOWN = '—';

const known = (value: Value): value is number => typeof value === 'number' && !Number.isNaN(value);

/** A minus of typographic width, and no "-0.0". */
const fixed = (value: number, digits: number): string => {
  const text = value.toFixed(digits);
  return Number(text) === 0 ? text.replace('-', '') : text.replace('-', '−');
};

export const number_text = (value: Value, digits: number, unit = ''): string =>
  known(value) ? `${fixed(value, digits)}${unit === '' ? '' : ` ${unit}`}` : UNKNOWN;

/** An angle: "30.0°". */
export const degrees_text = (value: Value): string =>
  known(value) ? `${fixed(value, 1)}°` : UNKNOWN;

/** 0.012 → "1.2 cm", 12.34 → "12.3 m", 1234 → "1.23 km". */
export const metres = (value: Value): string => {
  if (!known(value)) return UNKNOWN;
  const size = Math.abs(value);
  if (size < 0.1) return `${fixed(value * 100, 1)} cm`;
  if (size < 10) return `${fixed(value, 2)} m`;
  if (size < 1000) return `${fixed(value, size < 100 ? 1 : 0)} m`;
  return `${fixed(value / 1000, 2)} km`;
};

/** Where the robot is beside its path: "3.4 cm left". @param left_m positive: left of it */
export const beside = (left_m: Value): string => {
  if (!known(left_m)) return UNKNOWN;
  const side = left_m > 0 ? ' left' : left_m < 0 ? ' right' : '';
  return `${metres(Math.abs(left_m))}${side}`;
};

/** Accuracy as a radius: "±2 cm". */
export const accuracy = (value: Value): string => {
  if (!known(value)) return UNKNOWN;
  if (value < 1) return `±${Math.max(1, Math.round(value * 100))} cm`;
  return `±${fixed(value, value < 10 ? 1 : 0)} m`;
};

export const age = (seconds: Value): string => {
  if (!known(seconds)) return UNKNOWN;
  if (seconds < 10) return `${seconds.toFixed(1)} s`;
  if (seconds < 120) return `${Math.round(seconds)} s`;
  if (seconds < 7200) return `${Math.round(seconds / 60)} min`;
  return `${Math.round(seconds / 3600)} h`;
};

/** There and back: "4 ms", "0.5 s". */
export const round_trip_text = (seconds: Value): string =>
  known(seconds) && seconds < 0.1 ? `${Math.round(seconds * 1000)} ms` : age(seconds);

/** Time still needed: "45 s", "3 min 05 s", "1 h 12 min". */
export const duration = (seconds: Value): string => {
  if (!known(seconds)) return UNKNOWN;
  const whole = Math.round(seconds);
  const pair = (value: number): string => String(value).padStart(2, '0');
  if (whole < 60) return `${whole} s`;
  if (whole < 3600) return `${Math.floor(whole / 60)} min ${pair(whole % 60)} s`;
  return `${Math.floor(whole / 3600)} h ${pair(Math.floor((whole % 3600) / 60))} min`;
};

const WINDS = ['N', 'NE', 'E', 'SE', 'S', 'SW', 'W', 'NW'];

/** Compass direction with its wind: "048° NE". */
export const direction = (bearing_deg: Value): string => {
  if (!known(bearing_deg)) return UNKNOWN;
  const whole = Math.round(((bearing_deg % 360) + 360) % 360) % 360;
  return `${String(whole).padStart(3, '0')}° ${WINDS[Math.round(whole / 45) % 8] ?? ''}`;
};

/** 7 decimals are a centimetre: what a person can compare. */
export const coordinates = (at: LatLon | null): string =>
  at === null ? UNKNOWN : `${at.lat.toFixed(7)}, ${at.lon.toFixed(7)}`;

/** Local clock time of an RFC 3339 stamp. */
export const clock_time = (stamp: string): string => {
  const time = new Date(stamp);
  return Number.isNaN(time.getTime()) ? UNKNOWN : time.toTimeString().slice(0, 8);
};

export const day_and_time = (stamp: string): string => {
  const time = new Date(stamp);
  if (Number.isNaN(time.getTime())) return UNKNOWN;
  const pair = (value: number): string => String(value).padStart(2, '0');
  const day = `${time.getFullYear()}-${pair(time.getMonth() + 1)}-${pair(time.getDate())}`;
  return `${day} ${pair(time.getHours())}:${pair(time.getMinutes())}`;
};

/** A sentence of the server's begins with a small letter; one on the page does not. */
export const sentence = (text: string): string => text.charAt(0).toUpperCase() + text.slice(1);

/** Whether one of `said` holds the text, or the text holds it: nothing new for the reader. */
export const said_in = (text: string, said: readonly string[]): boolean => {
  const folded = text.toLowerCase();
  return said.some((other) => {
    const known = other.toLowerCase();
    return known !== '' && (known.includes(folded) || folded.includes(known));
  });
};

export const count = (value: number, one: string, many = `${one}s`): string =>
  `${value} ${value === 1 ? one : many}`;

/** "rows, Field 3 ,rows" → its words, each once. */
export const tags_of = (text: string): string[] => [
  ...new Set(
    text
      .split(',')
      .map((tag) => tag.trim())
      .filter((tag) => tag !== ''),
  ),
];

/** What people call the formats of mission files. */
export const format_words: Readonly<Record<string, string>> = {
  plan: 'QGroundControl',
  waypoints: 'QGC WPL, Mission Planner',
  gpx: 'GPX',
  kml: 'Google Earth',
  kmz: 'Google Earth, packed',
  geojson: 'GeoJSON',
  csv: 'table of latitude and longitude',
  follower: 'table of metres',
};
