// Places as people write them: degrees, degrees with minutes and seconds, UTM. Any of the three is
// read back, however it was pasted.

import { coordinates, UNKNOWN } from './format';
import type { LatLon } from './plan';
import { place_of_utm, utm_of } from './utm';

export type PlaceForm = 'degrees' | 'dms' | 'utm';

/** Two digits of a second are a third of a metre, three a few centimetres: what a person can use. */
const SECOND_DIGITS = 3;

const sexagesimal = (value: number, halves: readonly [plus: string, minus: string]): string => {
  const unit = 10 ** SECOND_DIGITS;
  const whole = Math.round(Math.abs(value) * 3600 * unit);
  const seconds = ((whole % (60 * unit)) / unit).toFixed(SECOND_DIGITS);
  const minutes = Math.floor(whole / (60 * unit)) % 60;
  const degrees = Math.floor(whole / (3600 * unit));
  const half = value < 0 && whole > 0 ? halves[1] : halves[0];
  return `${degrees}°${String(minutes).padStart(2, '0')}′${seconds.padStart(SECOND_DIGITS + 3, '0')}″${half}`;
};

/** "58.3780621, 26.7287794", "58°22′41.024″N 26°43′43.606″E", "35V 484137.71 6470834.21". */
export const place_text = (at: LatLon | null, form: PlaceForm): string => {
  if (at === null) return UNKNOWN;
  if (form === 'degrees') return coordinates(at);
  if (form === 'dms')
    return `${sexagesimal(at.lat, ['N', 'S'])} ${sexagesimal(at.lon, ['E', 'W'])}`;
  const utm = utm_of(at);
  if (utm === null) return coordinates(at);
  return `${utm.zone}${utm.band} ${utm.east_m.toFixed(2)} ${utm.north_m.toFixed(2)}`;
};

/** In a number alone: "58,378" is 58.378, as half of Europe writes. */
const number_of = (text: string): number => Number(text.replace(',', '.').replace('−', '-'));

const place = (lat: number, lon: number): LatLon | null =>
  Math.abs(lat) <= 90 && Math.abs(lon) <= 180 ? { lat, lon } : null;

const UTM =
  /^(\d{1,2})\s*([C-HJ-NP-X])\s+(\d{6}(?:[.,]\d+)?)\s*m?E?[\s,;]+(\d{1,8}(?:[.,]\d+)?)\s*m?N?$/i;
const PAIR =
  /^([-+−]?\d{1,3}(?:[.,]\d+)?)°?(?:\s*[,;]\s+|\s*;\s*|\s+)([-+−]?\d{1,3}(?:[.,]\d+)?)°?$/;
const TIGHT_PAIR = /^([-+−]?\d{1,3}\.\d+)°?,([-+−]?\d{1,3}\.\d+)°?$/;
const ANGLE =
  /(\d{1,3}(?:[.,]\d+)?)\s*°?\s*(?:(\d{1,2}(?:[.,]\d+)?)\s*['′’]\s*)?(?:(\d{1,2}(?:[.,]\d+)?)\s*(?:["″”]|'')\s*)?([NSEW])/gi;

const angle_of = (found: RegExpMatchArray): number => {
  const [, degrees = '', minutes = '0', seconds = '0', half = ''] = found;
  const [m, s] = [number_of(minutes), number_of(seconds)];
  if (m >= 60 || s >= 60) return NaN;
  return (number_of(degrees) + m / 60 + s / 3600) * (/[SW]/i.test(half) ? -1 : 1);
};

const halved = (text: string): LatLon | null => {
  const [first, second, ...more] = [...text.matchAll(ANGLE)];
  const rest = text.replaceAll(ANGLE, '').replaceAll(/[\s,;]/g, '');
  if (!first || !second || more.length > 0 || rest !== '') return null;
  const upright = (found: RegExpMatchArray): boolean => /[NS]/i.test(found[4] ?? '');
  if (upright(first) === upright(second)) return null;
  const [lat, lon] = upright(first) ? [first, second] : [second, first];
  return place(angle_of(lat), angle_of(lon));
};

/** @return null: no place can be read in it */
export const place_in = (text: string): LatLon | null => {
  const given = text.trim();
  const utm = UTM.exec(given);
  if (utm) {
    const [, zone = '', band = '', east = '', north = ''] = utm;
    const [east_m, north_m] = [number_of(east), number_of(north)];
    return place_of_utm({ zone: Number(zone), band: band.toUpperCase(), east_m, north_m });
  }
  const pair = TIGHT_PAIR.exec(given) ?? PAIR.exec(given);
  if (pair) return place(number_of(pair[1] ?? ''), number_of(pair[2] ?? ''));
  return halved(given);
};
