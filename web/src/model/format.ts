// Numbers as people read them. Null, undefined and NaN are "—".

import { fixed } from './figures';
import type { LatLon } from './plan';
import { language_now, say, told, type Language } from './say';

type Value = number | null | undefined;

export const UNKNOWN = '—';

const known = (value: Value): value is number => typeof value === 'number' && !Number.isNaN(value);

export const number_text = (value: Value, digits: number, unit = ''): string =>
  known(value) ? `${fixed(value, digits)}${unit === '' ? '' : ` ${unit}`}` : UNKNOWN;

/** An angle: "30.0°". */
export const degrees_text = (value: Value): string =>
  known(value) ? `${fixed(value, 1)}°` : UNKNOWN;

/** 0.012 → "1.2 cm", 12.34 → "12.3 m", 1234 → "1.23 km". */
export const metres = (value: Value): string => metres_as(value, value);

/** In the unit of another one that it stands beside. */
export const metres_as = (value: Value, other: Value): string => {
  if (!known(value)) return UNKNOWN;
  const size = Math.abs(known(other) ? other : value);
  if (size < 0.1) return `${fixed(value * 100, 1)} cm`;
  if (size < 10) return `${fixed(value, 2)} m`;
  if (size < 1000) return `${fixed(value, size < 100 ? 1 : 0)} m`;
  return `${fixed(value / 1000, size < 100_000 ? 2 : 0)} km`;
};

/** @param left positive: left */
export const side_word = (left: number): string =>
  left > 0 ? say('side_left') : say('side_right');

/** Where the robot is beside its path: "3.4 cm left". @param left_m positive: left of it */
export const beside = (left_m: Value): string => {
  if (!known(left_m)) return UNKNOWN;
  const size = metres(Math.abs(left_m));
  return left_m === 0 ? size : `${size} ${side_word(left_m)}`;
};

/** Of a file: "1.2 GB", "340 MB", "12 kB". */
export const file_size = (bytes: number): string => {
  if (bytes >= 1e9) return `${fixed(bytes / 1e9, 1)} GB`;
  if (bytes >= 1e6) return `${fixed(bytes / 1e6, bytes < 1e7 ? 1 : 0)} MB`;
  return `${Math.ceil(bytes / 1000)} kB`;
};

/** Accuracy as a radius: "±2 cm". */
export const accuracy = (value: Value): string => {
  if (!known(value)) return UNKNOWN;
  if (value < 1) return `±${Math.max(1, Math.round(value * 100))} cm`;
  return `±${fixed(value, value < 10 ? 1 : 0)} m`;
};

export const age = (seconds: Value): string => {
  if (!known(seconds)) return UNKNOWN;
  if (seconds < 10) return `${fixed(seconds, 1)} s`;
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
  if (whole < 3600)
    return say('whole_min_whole_2_s', { whole: Math.floor(whole / 60), whole_2: pair(whole % 60) });
  return say('whole_h_whole_2_min', {
    whole: Math.floor(whole / 3600),
    whole_2: pair(Math.floor((whole % 3600) / 60)),
  });
};

/** The letter that a language has for a wind. */
export const wind = (which: 'north' | 'east' | 'south' | 'west'): string => say(`wind_${which}`);

/** "13.47 m W, 1.20 m N" */
export const offset_words = (east_m: number, north_m: number): string =>
  `${Math.abs(east_m).toFixed(2)} m ${wind(east_m < 0 ? 'west' : 'east')}, ` +
  `${Math.abs(north_m).toFixed(2)} m ${wind(north_m < 0 ? 'south' : 'north')}`;

/** Clockwise from north. */
const winds = (): readonly string[] => {
  const [n, e, s, w] = [wind('north'), wind('east'), wind('south'), wind('west')];
  return [n, n + e, e, s + e, s, s + w, w, n + w];
};

/** Compass direction with its wind: "048° NE". */
export const direction = (bearing_deg: Value): string => {
  if (!known(bearing_deg)) return UNKNOWN;
  const whole = Math.round(((bearing_deg % 360) + 360) % 360) % 360;
  return `${String(whole).padStart(3, '0')}° ${winds()[Math.round(whole / 45) % 8] ?? ''}`;
};

/** 7 decimals are a centimetre: what a person can compare. */
export const coordinates = (at: LatLon | null): string =>
  at === null ? UNKNOWN : `${at.lat.toFixed(7)}, ${at.lon.toFixed(7)}`;

/** Local clock time of an RFC 3339 stamp. */
export const clock_time = (stamp: string): string => {
  const time = new Date(stamp);
  return Number.isNaN(time.getTime()) ? UNKNOWN : time.toTimeString().slice(0, 8);
};

const days = new Map<Language, Intl.DateTimeFormat>();
const day_format = (): Intl.DateTimeFormat => {
  const language = language_now();
  const locale = language === 'en' ? 'en-GB' : language;
  const known = days.get(language) ?? new Intl.DateTimeFormat(locale, { dateStyle: 'medium' });
  days.set(language, known);
  return known;
};

/** In the zone of who reads it: "1 May 2026, 09:05"; the month in words or in the language's order, so that
 * nobody takes it for the day. */
export const day_and_time = (stamp: string): string => {
  const time = new Date(stamp);
  if (Number.isNaN(time.getTime())) return UNKNOWN;
  return `${day_format().format(time)}, ${clock_time(stamp).slice(0, 5)}`;
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

/** What is counted on the page. */
export type Noun =
  | 'item'
  | 'cloud'
  | 'scan'
  | 'corner'
  | 'point'
  | 'area'
  | 'rally_point'
  | 'run'
  | 'place'
  | 'warning'
  | 'error'
  | 'difference'
  | 'time'
  | 'turn';
export const count = (value: number, noun: Noun): string => say(`n_${noun}`, { n: value });

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
export const format_words: Readonly<Record<string, string>> = told({
  plan: 'qgroundcontrol',
  waypoints: 'qgc_wpl_mission_planner',
  gpx: 'gpx_caps',
  kml: 'google_earth',
  kmz: 'google_earth_packed',
  geojson: 'geojson',
  csv: 'table_of_latitude_and_longitude',
  follower: 'table_of_metres',
});
