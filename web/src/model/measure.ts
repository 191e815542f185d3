// What a line drawn on the map measures: legs, all of it, and the area that it would enclose.

import { bearing_deg, distance_m } from './geo';
import { area_m2, type Places } from './outline';

export interface MeasuredLeg {
  readonly length_m: number;
  /** From its first end to its second, clockwise from north. */
  readonly bearing_deg: number;
}
export interface Measured {
  readonly legs: readonly MeasuredLeg[];
  readonly length_m: number;
  /** If its end were joined with its beginning; null: a line encloses nothing. */
  readonly ring: { readonly around_m: number; readonly area_m2: number } | null;
}

export const measured = (places: Places): Measured => {
  const legs = places.slice(1).map((to, k) => {
    const from = places[k] ?? to;
    return { length_m: distance_m(from, to), bearing_deg: bearing_deg(from, to) };
  });
  const length_m = legs.reduce((sum, leg) => sum + leg.length_m, 0);
  const [first, last] = [places[0], places.at(-1)];
  const closes = places.length > 2 && first && last;
  return {
    legs,
    length_m,
    ring: closes
      ? { around_m: length_m + distance_m(last, first), area_m2: area_m2(places) }
      : null,
  };
};
