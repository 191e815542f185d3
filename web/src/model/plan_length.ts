// How long the way through a plan is, as far as its places tell.

import { distance_m } from './geo';
import { place_of, type LatLon, type Plan } from './plan';

/** From a place to a circle, or off it: along its tangent from outside, else straight to it. */
const to_ring_m = (between_m: number, radius_m: number): number =>
  between_m > radius_m
    ? Math.sqrt(between_m * between_m - radius_m * radius_m)
    : radius_m - between_m;

/** Metres; circles all the way round. Moves, jumps and ways home are not counted. */
export const plan_length_m = (plan: Plan): number => {
  let sum = 0;
  let last: (LatLon & { readonly radius_m: number }) | null = null;
  for (const item of plan.items) {
    const at = place_of(item);
    if (!at) continue;
    const radius_m = item.type === 'circle' ? item.radius_m : 0;
    if (last) sum += to_ring_m(distance_m(last, at), Math.max(radius_m, last.radius_m));
    if (item.type === 'circle') sum += 2 * Math.PI * radius_m * (item.turns ?? 1);
    last = { ...at, radius_m };
  }
  return sum;
};
