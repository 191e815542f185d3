// The chosen items as a stretch of the list: reversed, thinned out, made denser, taken out, given the
// same properties; a mission cut in two, and two made one.

import type { PlanAction } from './actions';
import { field_value, fields_of, with_field, type Field } from './fields';
import type { Offset } from './geo';
import { plane_at } from './plane';
import { place_of, type Item, type Plan, type Waypoint } from './plan';
import { say } from './say';
import { in_order, picked_spots, type Picked } from './selection';

/** Jumps lead to the same items as before. @param new_number by old index, from 1; 0: it is gone */
const lead_jumps = (
  items: readonly Item[],
  new_number: readonly number[],
  count: number,
): Item[] => {
  const target = (old: number): number => {
    for (let index = old - 1; index < new_number.length; index += 1) {
      const found = new_number[index] ?? 0;
      if (found > 0) return found;
    }
    return Math.max(count, 1);
  };
  return items.map((item) => {
    if (item.type !== 'jump') return item;
    const to = target(item.item);
    return to === item.item ? item : { ...item, item: to };
  });
};

/** Each old item as what comes in its place; none: it goes. */
const rebuilt = (plan: Plan, of: (item: Item, index: number) => readonly Item[]): Plan => {
  const items: Item[] = [];
  const new_number: number[] = [];
  plan.items.forEach((item, index) => {
    const instead = of(item, index);
    items.push(...instead);
    // What is put in comes before the item itself.
    new_number.push(instead.length > 0 ? items.length : 0);
  });
  return { ...plan, items: lead_jumps(items, new_number, items.length) };
};

export const remove_items =
  (picked: Picked): PlanAction =>
  (plan) =>
    picked.size === 0 ? plan : rebuilt(plan, (item, index) => (picked.has(index) ? [] : [item]));

/** The chosen ones in the opposite order, where they stand; circles the other way round. */
export const reverse_stretch =
  (picked: Picked): PlanAction =>
  (plan) => {
    const order = in_order(picked);
    if (order.length < 2) return plan;
    const from = new Map(order.map((index, k) => [index, order[order.length - 1 - k] ?? index]));
    const new_number = plan.items.map((_, index) => (from.get(index) ?? index) + 1);
    const items = plan.items.map((_, index) => plan.items[from.get(index) ?? index] as Item);
    const turned = items.map((item, index) =>
      item.type === 'circle' && picked.has(index)
        ? { ...item, clockwise: item.clockwise !== true }
        : item,
    );
    return { ...plan, items: lead_jumps(turned, new_number, turned.length) };
  };

const segment_m = (p: Offset, a: Offset, b: Offset): number => {
  const [east, north] = [b.east_m - a.east_m, b.north_m - a.north_m];
  const length2 = east * east + north * north;
  const along = (p.east_m - a.east_m) * east + (p.north_m - a.north_m) * north;
  const share = length2 === 0 ? 0 : Math.min(1, Math.max(0, along / length2));
  return Math.hypot(p.east_m - a.east_m - share * east, p.north_m - a.north_m - share * north);
};

/** Which points of a line stay. A stack, not a recursion: a long straight line is no deep one.
 * Source: Ramer 1972, Douglas and Peucker 1973. */
const kept_of = (line: readonly Offset[], must_stay: readonly boolean[], most_m: number) => {
  const kept = [...must_stay];
  const fixed = [...kept.keys()].filter((k) => kept[k]);
  const work = fixed.slice(1).map((end, k): readonly [number, number] => [fixed[k] ?? 0, end]);
  for (let pair = work.pop(); pair; pair = work.pop()) {
    const [first, last] = pair;
    const [a, b] = [line[first], line[last]];
    let [farthest, farthest_m] = [-1, most_m];
    for (let k = first + 1; k < last && a && b; k += 1) {
      const p = line[k];
      const off_m = p ? segment_m(p, a, b) : 0;
      if (off_m > farthest_m) [farthest, farthest_m] = [k, off_m];
    }
    if (farthest < 0) continue;
    kept[farthest] = true;
    work.push([first, farthest], [farthest, last]);
  }
  return kept;
};

const driven_alike = (a: Waypoint, b: Waypoint): boolean =>
  (a.speed_mps ?? null) === (b.speed_mps ?? null) &&
  (a.radius_m ?? null) === (b.radius_m ?? null) &&
  (a.reverse ?? false) === (b.reverse ?? false) &&
  (a.turn ?? 'auto') === (b.turn ?? 'auto');

/** Takes waypoints out as long as the line stays within the tolerance. One stays where the robot
 * holds, where a jump leads, where something else is done, and where the next leg is driven
 * otherwise. */
export const simplify_items =
  (picked: Picked, tolerance_m: number): PlanAction =>
  (plan) => {
    const found = picked_spots(plan, picked);
    const [origin] = found;
    if (!origin || found.length < 3) return plan;
    const plane = plane_at(origin);
    const targets = new Set(
      plan.items.flatMap((item) => (item.type === 'jump' ? [item.item - 1] : [])),
    );
    const must_stay = found.map(({ index }, k) => {
      const item = plan.items[index];
      const next = plan.items[index + 1];
      if (k === 0 || k === found.length - 1 || item?.type !== 'waypoint') return true;
      if (next?.type !== 'waypoint' || found[k + 1]?.index !== index + 1) return true;
      if (found[k - 1]?.index !== index - 1) return true;
      return (item.hold_s ?? 0) > 0 || targets.has(index) || !driven_alike(item, next);
    });
    const kept = kept_of(
      found.map((spot) => plane.to_plane(spot)),
      must_stay,
      tolerance_m,
    );
    const gone = new Set(found.filter((_, k) => !kept[k]).map(({ index }) => index));
    return remove_items(gone)(plan);
  };

/** What nine decimals may add to a length. */
const ROUNDING_M = 0.001;

/** Waypoints on the legs between chosen waypoints that follow each other, evenly, so that none are
 * farther apart. */
export const densify_items =
  (picked: Picked, most_m: number): PlanAction =>
  (plan) => {
    let added = 0;
    const denser = rebuilt(plan, (item, index) => {
      const before = plan.items[index - 1];
      if (!picked.has(index) || !picked.has(index - 1)) return [item];
      if (item.type !== 'waypoint' || before?.type !== 'waypoint') return [item];
      const plane = plane_at(before);
      const { east_m, north_m } = plane.to_plane(item);
      const pieces = Math.ceil((Math.hypot(east_m, north_m) - ROUNDING_M) / most_m);
      const driven = with_field(item, 'hold_s', null) as Waypoint;
      const between = Array.from({ length: Math.max(0, pieces - 1) }, (_none, k): Waypoint => {
        const share = (k + 1) / pieces;
        const at = plane.from_plane({ east_m: east_m * share, north_m: north_m * share });
        return { ...driven, ...at };
      });
      added += between.length;
      return [...between, item];
    });
    return added === 0 ? plan : denser;
  };

/** The fields that every one of them has: what can be set for all. Places are not among them. */
export const shared_fields = (plan: Plan, picked: Picked): readonly Field[] => {
  const kinds = new Set(in_order(picked).flatMap((index) => plan.items[index]?.type ?? []));
  const [first, ...others] = kinds;
  if (!first) return [];
  return fields_of[first].filter(
    ({ key }) =>
      key !== 'lat' &&
      key !== 'lon' &&
      others.every((kind) => fields_of[kind].some((field) => field.key === key)),
  );
};

/** What all of them say; undefined: they differ. */
export const shared_value = (plan: Plan, picked: Picked, key: string): unknown => {
  const values = new Set(
    in_order(picked).flatMap((index) => {
      const item = plan.items[index];
      return item ? [field_value(item, key) ?? null] : [];
    }),
  );
  const [value] = values;
  return values.size === 1 ? value : undefined;
};

/** @param value null takes the field out: the default holds */
export const set_fields =
  (picked: Picked, key: string, value: unknown): PlanAction =>
  (plan) => ({
    ...plan,
    items: plan.items.map((item, index) =>
      picked.has(index) && fields_of[item.type].some((field) => field.key === key)
        ? with_field(item, key, value)
        : item,
    ),
  });

/** In two behind an item: the way is cut there, and both parts have the place. A jump out of its
 * part leads to the part's end. @param index of the item at which it is cut; it has a place */
export const split_at = (plan: Plan, index: number): readonly [Plan, Plan] => {
  const item = plan.items[index];
  const at_both = item && place_of(item) !== null ? index : index + 1;
  const first = remove_items(new Set([...plan.items.keys()].filter((k) => k > index)))(plan);
  const second = remove_items(new Set([...plan.items.keys()].filter((k) => k < at_both)))(plan);
  return [first, { ...second, name: `${plan.name} (2)` }];
};

/** Metres of two maps are not told apart in one mission. @return null: they can be joined */
export const why_not_join = (plan: Plan, other: Plan): string | null => {
  const [mine, theirs] = [plan.frame?.map, other.frame?.map];
  if (mine === undefined || theirs === undefined || mine === theirs) return null;
  return say('two_maps_are_not_joined', { mine, theirs, name: other.name });
};

/** The other one's items behind these, and its map where these count from none. */
export const join_plan =
  (other: Plan): PlanAction =>
  (plan) => {
    if (why_not_join(plan, other) !== null) return plan;
    const before = plan.items.length;
    const items = other.items.map((item) =>
      item.type === 'jump' ? { ...item, item: item.item + before } : item,
    );
    if (items.length === 0) return plan;
    const frame = plan.frame ?? other.frame;
    return { ...plan, items: [...plan.items, ...items], ...(frame ? { frame } : {}) };
  };
