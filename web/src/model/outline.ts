// Places that are drawn on the map and are no mission: the corners of a field, of a fence's area,
// rally points. Edits as pure functions, like those of a plan.

import { offset_between, rounded } from './geo';
import type { LatLon, Plan } from './plan';

export type Places = readonly LatLon[];

export const add_place =
  (at: LatLon) =>
  (places: Places): Places => [...places, rounded(at)];

export const insert_place =
  (index: number, at: LatLon) =>
  (places: Places): Places => [...places.slice(0, index), rounded(at), ...places.slice(index)];

export const move_place =
  (index: number, to: LatLon) =>
  (places: Places): Places =>
    places[index] === undefined
      ? places
      : places.map((old, k) => (k === index ? rounded(to) : old));

export const remove_place =
  (index: number) =>
  (places: Places): Places =>
    places[index] === undefined ? places : places.filter((_, k) => k !== index);

/** As the map draws it. */
export const plan_of_places = (places: Places): Plan => ({
  name: '',
  items: places.map(({ lat, lon }) => ({ type: 'waypoint', lat, lon })),
});

/** Area inside of a ring, m². */
export const area_m2 = (ring: Places): number => {
  const [origin] = ring;
  if (!origin) return 0;
  const corners = ring.map((corner) => offset_between(origin, corner));
  let twice = 0;
  corners.forEach((a, k) => {
    const b = corners[(k + 1) % corners.length] ?? a;
    twice += a.east_m * b.north_m - b.east_m * a.north_m;
  });
  return Math.abs(twice) / 2;
};

/** Without its holes; one that is not drawn to its end takes nothing away. */
export const field_m2 = ([field = [], ...holes]: readonly Places[]): number =>
  Math.max(
    0,
    holes.reduce((left_m2, hole) => left_m2 - area_m2(hole), area_m2(field)),
  );
