// How long the way through a plan is, as far as its places tell.

import { distance_m } from './geo';
import { place_of, type Item, type LatLon, type OnMap, type Plan } from './plan';

/** From a place to a circle, or off it: along its tangent from outside, else straight to it. */
const to_ring_m = (between_m: number, radius_m: number): number =>
  between_m > radius_m
    ? Math.sqrt(between_m * between_m - radius_m * radius_m)
    : radius_m - between_m;

type Placed = LatLon & { readonly radius_m: number };

/** The way to an item from the one before it, as long as neither is another one: an edit of one of
 * thousands changes two of them. */
const known = new WeakMap<Item, { readonly from: Item; readonly way_m: number }>();
const way_m = (from: Item, a: Placed, to: Item, b: Placed): number => {
  const found = known.get(to);
  if (found?.from === from) return found.way_m;
  const way_m = to_ring_m(distance_m(a, b), Math.max(a.radius_m, b.radius_m));
  known.set(to, { from, way_m });
  return way_m;
};

/** Metres; circles all the way round. Moves, jumps and ways home are not counted, nor is the way between
 * a place on the earth and a point of a map. */
export const plan_length_m = (plan: Plan): number => {
  let sum = 0;
  let last: { readonly item: Item; readonly at: Placed } | null = null;
  let in_map: OnMap | null = null;
  for (const item of plan.items) {
    if (item.type === 'map_point') {
      if (in_map) sum += Math.hypot(item.x_m - in_map.x_m, item.y_m - in_map.y_m);
      in_map = item;
      last = null;
      continue;
    }
    const place = place_of(item);
    if (!place) continue;
    in_map = null;
    const radius_m = item.type === 'circle' ? item.radius_m : 0;
    const at = { lat: place.lat, lon: place.lon, radius_m };
    if (last) sum += way_m(last.item, last.at, item, at);
    if (item.type === 'circle') sum += 2 * Math.PI * radius_m * (item.turns ?? 1);
    last = { item, at };
  }
  return sum;
};
