import { describe, expect, test } from 'vitest';

import { distance_m } from '../src/model/geo';
import { plane_at } from '../src/model/plane';
import type { Item, LatLon, Plan } from '../src/model/plan';
import { run_between } from '../src/model/selection';
import {
  densify_items,
  join_plan,
  remove_items,
  reverse_stretch,
  set_fields,
  shared_fields,
  shared_value,
  simplify_items,
  split_at,
  why_not_join,
} from '../src/model/stretch';
import {
  first_amounts,
  TRANSFORMS,
  why_not_apply,
  why_not_transform,
} from '../src/model/transforms';

const plane = plane_at({ lat: 58.378, lon: 26.729 });
const point = (east_m: number, north_m: number, more: object = {}): Item =>
  ({ type: 'waypoint', ...plane.from_plane({ east_m, north_m }), ...more }) as Item;
const jump = (item: number): Item => ({ type: 'jump', item, times: 1 });
const plan = (...items: Item[]): Plan => ({ name: 'P', items });
const east = (item: Item | undefined): number =>
  Math.round(plane.to_plane(item as unknown as LatLon).east_m * 1000) / 1000 + 0;
const told = (of: Plan): unknown[] =>
  of.items.map((item) => (item.type === 'waypoint' ? east(item) : item));

describe('a stretch', () => {
  test('is taken out, and jumps lead to what comes in its place', () => {
    const before = plan(point(0, 0), point(1, 0), point(2, 0), point(3, 0), jump(2), jump(4));
    expect(told(remove_items(new Set([1, 2]))(before))).toEqual([0, 3, jump(2), jump(2)]);
    expect(told(remove_items(run_between(0, 5))(before))).toEqual([]);
  });

  test('is reversed where it stands; jumps and circles go with it', () => {
    const circle: Item = { type: 'circle', lat: 58, lon: 26, radius_m: 3, clockwise: true };
    const before = plan(point(0, 0), point(1, 0), point(2, 0), circle, point(9, 0), jump(2));
    const after = reverse_stretch(run_between(1, 3))(before);
    expect(told(after)).toEqual([0, { ...circle, clockwise: false }, 2, 1, 9, jump(4)]);
    expect(reverse_stretch(run_between(1, 3))(after)).toEqual(before);
  });

  test('that is thinned out stays within the tolerance', () => {
    const wavy = Array.from({ length: 101 }, (_, k) => point(k, k % 2 === 0 ? 0 : 0.04));
    expect(simplify_items(run_between(0, 100), 0.05)(plan(...wavy)).items).toHaveLength(2);
    expect(simplify_items(run_between(0, 100), 0.03)(plan(...wavy)).items.length).toBeGreaterThan(
      50,
    );
    const corner = plan(point(0, 0), point(5, 0), point(5, 5));
    expect(simplify_items(run_between(0, 2), 0.5)(corner)).toBe(corner);
  });

  test('keeps, thinned out, where it holds, a jump leads, or it drives otherwise', () => {
    const before = plan(
      point(0, 0),
      point(1, 0, { hold_s: 2 }),
      point(2, 0),
      point(3, 0, { speed_mps: 0.3 }),
      point(4, 0),
      { type: 'wait', seconds: 1 },
      point(5, 0),
      point(6, 0),
      jump(7),
    );
    expect(told(simplify_items(run_between(0, 7), 0.1)(before))).toEqual([
      ...[0, 1, 2, 3, 4],
      { type: 'wait', seconds: 1 },
      ...[5, 6],
      jump(7),
    ]);
  });

  test('ten thousand in a straight line are thinned out at once', () => {
    const line = Array.from({ length: 10_000 }, (_, k) => point(k * 0.1, 0));
    expect(simplify_items(run_between(0, 9999), 0.01)(plan(...line)).items).toHaveLength(2);
  });

  test('is made denser evenly; the new points drive as the leg does and hold nowhere', () => {
    const before = plan(point(0, 0), point(10, 0, { speed_mps: 0.4, hold_s: 3 }), jump(2));
    const after = densify_items(run_between(0, 1), 4)(before);
    expect(told(after).slice(0, 4)).toEqual([0, 3.333, 6.667, 10]);
    expect(after.items[1]).toMatchObject({ speed_mps: 0.4 });
    expect(after.items[1]).not.toHaveProperty('hold_s');
    expect(after.items[3]).toMatchObject({ hold_s: 3 });
    expect(after.items[4]).toEqual(jump(4));
    expect(densify_items(run_between(0, 1), 10)(before)).toBe(before);
  });
});

describe('properties of several', () => {
  const mixed = plan(point(0, 0, { speed_mps: 0.5 }), point(1, 0), { type: 'wait', seconds: 2 });

  test('are the fields that all of them have, but no places', () => {
    expect(shared_fields(mixed, new Set([0, 1])).map(({ key }) => key)).toEqual([
      ...['speed_mps', 'hold_s', 'radius_m', 'turn', 'reverse'],
    ]);
    expect(shared_fields(mixed, new Set([0, 2]))).toEqual([]);
  });

  test('say what all of them say, or that they differ', () => {
    expect(shared_value(mixed, new Set([0, 1]), 'speed_mps')).toBeUndefined();
    expect(shared_value(mixed, new Set([0]), 'speed_mps')).toBe(0.5);
    expect(shared_value(mixed, new Set([0, 1]), 'hold_s')).toBeNull();
  });

  test('say the side of landmarks also where an offset says it', () => {
    const cones = (more: object): Item => ({ type: 'landmarks', name: 'cone', ...more }) as Item;
    const both = plan(cones({ offset_m: 0.7 }), cones({ side: 'right' }), cones({ side: 'left' }));
    expect(shared_value(both, new Set([0]), 'side')).toBe('right');
    expect(shared_value(both, new Set([0, 1]), 'side')).toBe('right');
    expect(shared_value(both, new Set([0, 2]), 'side')).toBeUndefined();
  });

  test('are set for all of them, and taken out again', () => {
    const slow = set_fields(new Set([0, 1, 2]), 'speed_mps', 0.2)(mixed);
    expect(slow.items[1]).toMatchObject({ speed_mps: 0.2 });
    expect(slow.items[2]).toBe(mixed.items[2]);
    expect(set_fields(new Set([0]), 'speed_mps', null)(mixed).items[0]).not.toHaveProperty(
      'speed_mps',
    );
  });
});

describe('two missions', () => {
  test('are made of one: both have the place where it was cut', () => {
    const [a, b] = split_at(plan(point(0, 0), point(1, 0), point(2, 0), jump(3)), 1);
    expect(told(a)).toEqual([0, 1]);
    expect(told(b)).toEqual([1, 2, jump(2)]);
    expect(b.name).toBe('P (2)');
  });

  test('become one: the other one’s jumps lead to its own items', () => {
    const joined = join_plan(plan(point(5, 0), jump(1)))(plan(point(0, 0), point(1, 0)));
    expect(told(joined)).toEqual([0, 1, 5, jump(3)]);
  });

  test('become one with the map of the one that counts from one', () => {
    const on_map: Item = { type: 'map_point', x_m: 1, y_m: 2 };
    const plain = plan(point(0, 0));
    const shed: Plan = { ...plan(on_map), frame: { map: 'shed' } };
    for (const mine of [plain, { ...plain, frame: null }, { ...plain, frame: { map: 'shed' } }]) {
      expect(why_not_join(mine, shed)).toBeNull();
      expect(join_plan(shed)(mine)).toEqual({
        ...plain,
        items: [...plain.items, on_map],
        frame: { map: 'shed' },
      });
    }
    expect(join_plan(plain)(shed).frame).toEqual({ map: 'shed' });
    expect(join_plan(plain)(plain)).not.toHaveProperty('frame');
  });

  test('that count from two maps stay two, and both maps are named', () => {
    const shed: Plan = { ...plan(point(0, 0)), frame: { map: 'shed' } };
    const yard: Plan = { ...plan(point(1, 0)), name: 'Q', frame: { map: 'yard' } };
    expect(why_not_join(shed, yard)).toMatch(/map “shed” and “Q” from “yard”/);
    expect(join_plan(yard)(shed)).toBe(shed);
  });
});

describe('the table of transforms', () => {
  const line = plan(point(0, 0), point(5, 1), point(10, 0), {
    type: 'local',
    east_m: 1,
    north_m: 1,
  });

  test('says how many points are missing, and what cannot be moved', () => {
    const why = (key: string, ...picked: number[]): string | null => {
      const transform = TRANSFORMS.find((each) => each.key === key);
      return transform ? why_not_transform(transform, line, new Set(picked)) : 'no such';
    };
    expect(why('rotate', 0)).toBe('1 more point must be selected.');
    expect(why('simplify')).toBe('3 more points must be selected.');
    expect(why('move', 0)).toBeNull();
    expect(why('rotate', 0, 1, 3)).toContain('measured from home');
  });

  test('each of them changes something when its amounts are not the first ones', () => {
    const picked = new Set([0, 1, 2]);
    for (const transform of TRANSFORMS) {
      const begun = first_amounts(transform);
      const other = { ...begun, east: 1, deg: 30, percent: 50, right: 1 };
      const amounts = transform.key === 'simplify' ? { m: 2 } : other;
      const after = transform.action(picked, amounts)(line);
      expect(why_not_apply(line, after), transform.key).toBeNull();
      expect(
        distance_m(line.items[0] as Item & LatLon, after.items[0] as Item & LatLon),
      ).toBeLessThan(20);
    }
    expect(why_not_apply(line, line)).toBe('This changes nothing.');
  });
});
