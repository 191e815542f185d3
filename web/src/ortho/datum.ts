// Which datum a coordinate system is made on, and how it is brought to WGS 84.

import { DATUMS } from './datums';

export interface Shift {
  /** It is good to so many metres. */
  readonly good_to_m: number;
  /** Where it holds: west, south, east, north in degrees; null: everywhere. */
  readonly area: readonly number[] | null;
  /** As PROJ's towgs84; none: it coincides with WGS 84. */
  readonly towgs84: readonly number[];
}

export interface Datum {
  readonly name: string;
  /** The best one first. */
  readonly shifts: readonly Shift[];
}

const numbers = (text: string): number[] => text.split(' ').map(Number);

const shift_of = (part: string): Shift => {
  const [good_to_m = 0, ...rest] = numbers(part);
  return rest.length === 0
    ? { good_to_m, area: null, towgs84: [] }
    : { good_to_m, area: rest.slice(0, 4), towgs84: rest.slice(4) };
};

/** By the first and the last of some codes. */
const listed = DATUMS.trim()
  .split('\n')
  .flatMap((line) => {
    const [head = '', ...shifts] = line.split(';');
    const colon = head.lastIndexOf(':');
    const datum: Datum = { name: head.slice(0, colon), shifts: shifts.map(shift_of) };
    return head
      .slice(colon + 1)
      .split(' ')
      .map((range) => {
        const [first = Number.NaN, last = first] = range.split('-').map(Number);
        return { first, last, datum };
      });
  });

/** @param code of a geographic or projected system. @return null: how it lies is not known */
export const datum_of = (code: number): Datum | null =>
  listed.find(({ first, last }) => code >= first && code <= last)?.datum ?? null;

const holds = ({ area }: Shift, lon: number, lat: number): boolean => {
  if (area === null) return true;
  const [west = 0, south = 0, east = 0, north = 0] = area;
  const within = (at: number): boolean => at >= west && at <= east;
  return lat >= south && lat <= north && (within(lon) || within(lon + 360));
};

/** Those that hold at a place: where areas overlap there are more. The best one first. */
export const shifts_at = (datum: Datum, lon: number, lat: number): readonly Shift[] =>
  datum.shifts.filter((shift) => holds(shift, lon, lat));
