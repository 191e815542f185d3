// Edits as pure functions: each takes its arguments and gives a map from plan to plan. The old plan
// is never touched, so undo costs nothing. An action that would change nothing returns the plan
// itself. Items that name other items by number (jump) keep pointing at the same item.

import { rounded } from './geo';
import { place_of } from './plan';
import type { Home, Item, LatLon, Plan, Settings, Waypoint } from './plan';

export type PlanAction = (plan: Plan) => Plan;

const renumber_jumps = (items: readonly Item[], to_new: (number: number) => number): Item[] =>
  items.map((item) => {
    if (item.type !== 'jump') return item;
    const target = to_new(item.item);
    return target === item.item ? item : { ...item, item: target };
  });

/** @param index where the new item stands afterwards; clamped to the list. */
export const insert_item =
  (index: number, item: Item): PlanAction =>
  (plan) => {
    const at = Math.min(Math.max(index, 0), plan.items.length);
    const items = renumber_jumps(plan.items, (number) => (number > at ? number + 1 : number));
    items.splice(at, 0, item);
    return { ...plan, items };
  };

export const insert_waypoint = (index: number, at: LatLon): PlanAction =>
  insert_item(index, { type: 'waypoint', ...rounded(at) });

export const append_item =
  (item: Item): PlanAction =>
  (plan) =>
    insert_item(plan.items.length, item)(plan);

export const append_waypoint = (at: LatLon): PlanAction =>
  append_item({ type: 'waypoint', ...rounded(at) });

export const remove_item =
  (index: number): PlanAction =>
  (plan) => {
    if (plan.items[index] === undefined) return plan;
    const rest = plan.items.filter((_, k) => k !== index);
    // A jump to the removed item goes to the one that took its number; the last becomes shorter.
    const to_new = (number: number): number =>
      Math.max(1, Math.min(number > index + 1 ? number - 1 : number, rest.length));
    return { ...plan, items: renumber_jumps(rest, to_new) };
  };

export const replace_item =
  (index: number, item: Item): PlanAction =>
  (plan) =>
    plan.items[index] === undefined || plan.items[index] === item
      ? plan
      : { ...plan, items: plan.items.map((old, k) => (k === index ? item : old)) };

/** Moves an item that has a place; any other stays as it is. */
export const move_waypoint =
  (index: number, to: LatLon): PlanAction =>
  (plan) => {
    const item = plan.items[index];
    if (!item || place_of(item) === null) return plan;
    return replace_item(index, { ...item, ...rounded(to) } as Item)(plan);
  };

/** Changes some fields of a waypoint. A null takes the field out: the mission's default holds. */
export const edit_waypoint =
  (index: number, change: Partial<Waypoint>): PlanAction =>
  (plan) => {
    const item = plan.items[index];
    if (item?.type !== 'waypoint') return plan;
    const changed = Object.entries({ ...item, ...change }).filter(([, value]) => value !== null);
    return replace_item(index, Object.fromEntries(changed) as unknown as Waypoint)(plan);
  };

/** @param to where the item stands afterwards. */
export const reorder_item =
  (from: number, to: number): PlanAction =>
  (plan) => {
    const item = plan.items[from];
    if (item === undefined || to < 0 || to >= plan.items.length || from === to) return plan;
    const order = plan.items.map((_, k) => k);
    order.splice(from, 1);
    order.splice(to, 0, from);
    const new_number = new Map(order.map((old, now) => [old + 1, now + 1]));
    const items = renumber_jumps(plan.items, (number) => new_number.get(number) ?? number);
    return { ...plan, items: order.map((old) => items[old] ?? item) };
  };

/** The same items in the opposite order; circles the other way round. */
export const reverse_items: PlanAction = (plan) => {
  const count = plan.items.length;
  const items = renumber_jumps(plan.items, (number) => count + 1 - number);
  const turned = items.map((item) =>
    item.type === 'circle' ? { ...item, clockwise: item.clockwise !== true } : item,
  );
  return { ...plan, items: turned.reverse() };
};

export const clear_items: PlanAction = (plan) =>
  plan.items.length === 0 ? plan : { ...plan, items: [] };

export const rename =
  (name: string): PlanAction =>
  (plan) =>
    name === plan.name ? plan : { ...plan, name };

export const set_home =
  (home: Home | null): PlanAction =>
  (plan) => ({ ...plan, home });

/** @param map its name; null: from none */
export const count_from =
  (map: string | null): PlanAction =>
  (plan) => ({ ...plan, frame: map === null ? null : { map } });

export const change_settings =
  (change: Settings): PlanAction =>
  (plan) => ({ ...plan, settings: { ...plan.settings, ...change } });
