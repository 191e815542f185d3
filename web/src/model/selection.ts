// Several items at once: which are chosen, where they lie, what belongs to them.

import { count } from './format';
import { place_of, spots, type LatLon, type Plan } from './plan';
import { say } from './say';

/** Indices of items. */
export type Picked = ReadonlySet<number>;

export const NOTHING_PICKED: Picked = new Set();

export const toggled = (picked: Picked, index: number): Picked => {
  const next = new Set(picked);
  if (!next.delete(index)) next.add(index);
  return next;
};

/** From one to the other, both included. */
export const run_between = (from: number, to: number): Picked => {
  const [first, last] = from <= to ? [from, to] : [to, from];
  return new Set(Array.from({ length: last - first + 1 }, (_, k) => first + k));
};

export const joined = (a: Picked, b: Iterable<number>): Picked => new Set([...a, ...b]);

export const all_of = (plan: Plan): Picked => new Set(plan.items.keys());

/** The same items after a change, whatever their numbers are then. Of as many as before, one that is
 * another was changed where it stood. */
export const followed = (picked: Picked, before: Plan, after: Plan): Picked => {
  if (picked.size === 0 || before.items === after.items) return picked;
  const places = new Map(after.items.map((item, index) => [item, index]));
  const as_many = before.items.length === after.items.length;
  const left = [...picked].flatMap((index) => {
    const item = before.items[index];
    const place = item && places.get(item);
    return place ?? (as_many ? index : []);
  });
  return new Set(left);
};

export const in_order = (picked: Picked): readonly number[] => [...picked].sort((a, b) => a - b);

/** The chosen items that have a place, in driving order. */
export const picked_spots = (plan: Plan, picked: Picked): ReturnType<typeof spots> =>
  spots(plan).filter(({ index }) => picked.has(index));

/** Also what has no place and comes right after a chosen one: it is done there. */
export const with_followers = (plan: Plan, picked: Picked): Picked => {
  const all = new Set(picked);
  plan.items.forEach((item, index) => {
    if (place_of(item) === null && all.has(index - 1)) all.add(index);
  });
  return all;
};

/** Middle of the extremes. */
export const middle_of = (places: readonly LatLon[]): LatLon | null => {
  const [first] = places;
  if (!first) return null;
  let [south, north, west, east] = [first.lat, first.lat, first.lon, first.lon];
  for (const { lat, lon } of places) {
    south = Math.min(south, lat);
    north = Math.max(north, lat);
    west = Math.min(west, lon);
    east = Math.max(east, lon);
  }
  return { lat: (south + north) / 2, lon: (west + east) / 2 };
};

/** "items 3 to 7", "5 items of 2 to 40". */
export const picked_words = (picked: Picked): string => {
  const order = in_order(picked);
  const [first = 0] = order;
  const last = order.at(-1) ?? first;
  if (order.length === 1) return say('item_first', { first: first + 1 });
  if (last - first + 1 === order.length)
    return say('items_first_to_last', { first: first + 1, last: last + 1 });
  return say('order_from_first_to_last', {
    order: count(order.length, 'item'),
    first: first + 1,
    last: last + 1,
  });
};
