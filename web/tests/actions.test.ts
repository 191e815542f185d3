import { describe, expect, test } from 'vitest';

import {
  append_waypoint,
  change_settings,
  clear_items,
  edit_waypoint,
  insert_item,
  insert_waypoint,
  move_waypoint,
  remove_item,
  rename,
  reorder_item,
  replace_item,
  reverse_items,
} from '../src/model/actions';
import type { Item, Plan } from '../src/model/plan';

const at = (lat: number): Item => ({ type: 'waypoint', lat, lon: 26 });
const jump = (item: number): Item => ({ type: 'jump', item, times: 1 });
const plan = (...items: Item[]): Plan => ({ name: 'P', items });
const lats = (p: Plan): unknown[] =>
  p.items.map((item) => (item.type === 'waypoint' ? item.lat : item.type));

describe('actions', () => {
  test('leave the old plan untouched', () => {
    const before = plan(at(1), at(2));
    const frozen = JSON.stringify(before);
    for (const action of [
      append_waypoint({ lat: 3, lon: 4 }),
      insert_waypoint(1, { lat: 3, lon: 4 }),
      move_waypoint(0, { lat: 3, lon: 4 }),
      remove_item(0),
      reorder_item(0, 1),
      reverse_items,
      rename('Q'),
      clear_items,
      change_settings({ at_end: 'repeat' }),
    ]) {
      expect(action(before)).not.toBe(before);
    }
    expect(JSON.stringify(before)).toBe(frozen);
  });

  test('keep nine decimals of a tap and wrap its longitude', () => {
    const added = append_waypoint({ lat: 58.1234567891234, lon: 190 })(plan());
    expect(added.items[0]).toEqual({ type: 'waypoint', lat: 58.123456789, lon: -170 });
  });

  test('insert before, between, after and far outside of the list', () => {
    const before = plan(at(1), at(2));
    const added = { lat: 9, lon: 9 };
    expect(lats(insert_waypoint(0, added)(before))).toEqual([9, 1, 2]);
    expect(lats(insert_waypoint(1, added)(before))).toEqual([1, 9, 2]);
    expect(lats(insert_waypoint(99, added)(before))).toEqual([1, 2, 9]);
    expect(lats(insert_waypoint(-3, added)(before))).toEqual([9, 1, 2]);
  });

  test('keep a jump at the item it named when items come before it', () => {
    const before = plan(at(1), at(2), jump(2));
    expect(insert_item(1, at(9))(before).items[3]).toEqual(jump(3));
    expect(insert_item(2, at(9))(before).items[3]).toEqual(jump(2));
  });

  test('keep a jump at the item it named when items before it go', () => {
    const before = plan(at(1), at(2), at(3), jump(3));
    expect(remove_item(0)(before).items[2]).toEqual(jump(2));
    expect(remove_item(2)(before).items[2]).toEqual(jump(3));
    expect(remove_item(1)(plan(at(1), at(2), jump(3))).items[1]).toEqual(jump(2));
  });

  test('keep a jump at the item it named when the order changes', () => {
    const before = plan(at(1), at(2), at(3), jump(1));
    const later = reorder_item(0, 2)(before);
    expect(lats(later)).toEqual([2, 3, 1, 'jump']);
    expect(later.items[3]).toEqual(jump(3));
    const turned = reverse_items(before);
    expect(lats(turned)).toEqual(['jump', 3, 2, 1]);
    expect(turned.items[0]).toEqual(jump(4));
    const round: Item = { type: 'circle', lat: 1, lon: 2, radius_m: 3, clockwise: true };
    expect(reverse_items(plan(round)).items).toEqual([{ ...round, clockwise: false }]);
    const moved = move_waypoint(0, { lat: 5, lon: 6 })(plan(round));
    expect(moved.items).toEqual([{ ...round, lat: 5, lon: 6 }]);
  });

  test('that would change nothing return the plan itself', () => {
    const before = plan(at(1), jump(1));
    expect(remove_item(7)(before)).toBe(before);
    expect(move_waypoint(1, { lat: 0, lon: 0 })(before)).toBe(before);
    expect(replace_item(5, at(1))(before)).toBe(before);
    expect(replace_item(0, before.items[0] as Item)(before)).toBe(before);
    expect(reorder_item(0, 0)(before)).toBe(before);
    expect(reorder_item(0, 2)(before)).toBe(before);
    expect(rename('P')(before)).toBe(before);
    expect(clear_items(plan()).items).toHaveLength(0);
  });

  test('set and take out fields of a waypoint, and keep the others when it moves', () => {
    const fast = edit_waypoint(0, { speed_mps: 0.7, hold_s: 2 })(plan(at(1)));
    const moved = move_waypoint(0, { lat: 5, lon: 6 })(fast);
    expect(moved.items[0]).toEqual({ type: 'waypoint', lat: 5, lon: 6, speed_mps: 0.7, hold_s: 2 });
    const plain = edit_waypoint(0, { speed_mps: null })(moved);
    expect(plain.items[0]).toEqual({ type: 'waypoint', lat: 5, lon: 6, hold_s: 2 });
  });
});
