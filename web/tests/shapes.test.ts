import { describe, expect, test } from 'vitest';

import { bearing_deg, distance_m, offset_between, offset_from } from '../src/model/geo';
import { plane_at } from '../src/model/plane';
import type { Item, LatLon, Plan, Row, Wall } from '../src/model/plan';
import { followed, picked_words, run_between, toggled } from '../src/model/selection';
import {
  align_items,
  drag_items,
  mirror_items,
  move_items,
  parallel_items,
  rotate_items,
  scale_items,
} from '../src/model/shapes';

const TARTU: LatLon = { lat: 58.378, lon: 26.729 };
const point = (east_m: number, north_m: number): Item => ({
  type: 'waypoint',
  ...plane_at(TARTU).from_plane({ east_m, north_m }),
});
const plan = (...items: Item[]): Plan => ({ name: 'P', items });
const place = (of: Plan, k: number): LatLon => of.items[k] as unknown as LatLon;
/** East and north of Tartu, to the millimetre. */
const seen = (of: Plan): [number, number][] =>
  of.items.map((_, k) => {
    const { east_m, north_m } = plane_at(TARTU).to_plane(place(of, k));
    const mm = (metres: number): number => Math.round(metres * 1000) / 1000 + 0;
    return [mm(east_m), mm(north_m)];
  });
const both = new Set([0, 1]);

describe('the plane', () => {
  test('gives back what it was given, within a tenth of a millimetre over a kilometre', () => {
    const plane = plane_at(TARTU);
    for (const [east_m, north_m] of [
      [0, 0],
      [1000, 0],
      [-700, 700],
      [3, -1000],
    ] as const) {
      const back = plane.to_plane(plane.from_plane({ east_m, north_m }));
      expect(Math.hypot(back.east_m - east_m, back.north_m - north_m)).toBeLessThan(1.5e-4);
    }
  });

  test('agrees with the distances that label the map', () => {
    const at = plane_at(TARTU).from_plane({ east_m: 300, north_m: 400 });
    expect(distance_m(TARTU, at)).toBeCloseTo(500, 2);
  });
});

describe('a figure', () => {
  test('that is moved keeps its shape, and what was not chosen stays', () => {
    const before = plan(point(0, 0), point(10, 0), point(10, 10));
    const after = move_items(both, { east_m: 5, north_m: -2 })(before);
    expect(seen(after)).toEqual([
      [5, -2],
      [15, -2],
      [10, 10],
    ]);
    expect(after.items[2]).toBe(before.items[2]);
  });

  test('follows the point that is dragged', () => {
    const before = plan(point(0, 0), point(10, 0));
    const to = plane_at(TARTU).from_plane({ east_m: 12, north_m: 3 });
    expect(seen(drag_items(both, 1, to)(before))).toEqual([
      [2, 3],
      [12, 3],
    ]);
  });

  test('turns clockwise about its middle, and its headings turn with it', () => {
    const turn: Item = { type: 'turn', heading_deg: 350 };
    const before = plan(point(-5, 0), point(5, 0), turn);
    const after = rotate_items(both, 90, null)(before);
    expect(bearing_deg(place(after, 0), place(after, 1))).toBeCloseTo(180, 4);
    expect(distance_m(place(after, 0), place(after, 1))).toBeCloseTo(10, 3);
    expect(after.items[2]).toEqual({ type: 'turn', heading_deg: 80 });
  });

  describe('with rows and walls that end beside a place', () => {
    const ends = (east_m: number, north_m: number) => {
      const { lat, lon } = plane_at(TARTU).from_plane({ east_m, north_m });
      return { until_lat: lat, until_lon: lon };
    };
    const row = (east_m: number, north_m: number): Item => ({
      type: 'row',
      ...ends(east_m, north_m),
    });
    const wall: Item = { type: 'wall', side: 'left', distance_m: 1, ...ends(0, 4) };
    // The last one comes after a point that is not chosen.
    const before = plan(point(-5, 0), row(5, 4), point(5, 0), wall, point(20, 0), row(30, 0));
    const end_of = (of: Plan, k: number): readonly [number, number] => {
      const { until_lat: lat, until_lon: lon } = of.items[k] as Row | Wall;
      if (typeof lat !== 'number' || typeof lon !== 'number') throw new Error('ends nowhere');
      const { east_m, north_m } = plane_at(TARTU).to_plane({ lat, lon });
      const cm = (metres: number): number => Math.round(metres * 100) / 100 + 0;
      return [cm(east_m), cm(north_m)];
    };
    const chosen = new Set([0, 2]);

    test.each([
      ['moved', move_items(chosen, { east_m: 3, north_m: -2 }), [8, 2], [3, 2]],
      ['turned', rotate_items(chosen, 90, TARTU), [4, -5], [4, 0]],
      ['scaled', scale_items(chosen, 2, TARTU), [10, 8], [0, 8]],
      ['mirrored', mirror_items(chosen, 0, TARTU), [-5, 4], [0, 4]],
      ['dragged', drag_items(chosen, 0, place(plan(point(-4, 1)), 0)), [6, 5], [1, 5]],
      ['offset', parallel_items(chosen, 2), [5, 2], [0, 2]],
      ['straightened', align_items(chosen), [5, 0], [0, 0]],
    ] as const)('is %s with their ends', (_done, change, row_end, wall_end) => {
      const after = change(before);
      expect(end_of(after, 1)).toEqual(row_end);
      expect(end_of(after, 3)).toEqual(wall_end);
      expect(after.items[5]).toBe(before.items[5]);
    });

    test('mirrors the side of walls and landmarks, which may say no distance', () => {
      const items: Item[] = [
        { type: 'wall', side: 'left' },
        { type: 'landmarks', name: 'any', side: 'right' },
        { type: 'landmarks', name: 'any', offset_m: 0.7 },
      ];
      const after = mirror_items(new Set([0, 1, 2, 3]), 0, TARTU)(plan(point(0, 0), ...items));
      expect(after.items.slice(1)).toEqual([
        { type: 'wall', side: 'right' },
        { type: 'landmarks', name: 'any', side: 'left' },
        { type: 'landmarks', name: 'any', offset_m: -0.7 },
      ]);
    });

    test('leaves one alone that ends beside a known place, or nowhere', () => {
      const named: Item = { type: 'row', until_place: 'gate' };
      const bare: Item = { type: 'wall', side: 'left', distance_m: 1 };
      const after = move_items(both, { east_m: 3, north_m: 0 })(plan(point(0, 0), named, bare));
      expect(after.items.slice(1)).toEqual([named, bare]);
    });
  });

  test('of a kilometre keeps its shape when it is turned, and comes back', () => {
    const before = plan(point(-500, -500), point(500, -500), point(500, 500), point(-500, 500));
    const all = run_between(0, 3);
    const turned = rotate_items(all, 37, TARTU)(before);
    const diagonal = (of: Plan): number => {
      const { east_m, north_m } = plane_at(place(of, 0)).to_plane(place(of, 2));
      return Math.hypot(east_m, north_m);
    };
    expect(diagonal(turned)).toBeCloseTo(diagonal(before), 3);
    expect(seen(rotate_items(all, -37, TARTU)(turned))).toEqual(seen(before));
  });

  test('that is scaled has its moves and circles grow, but not what is set for a waypoint', () => {
    const before = plan(
      { ...point(-2, 0), radius_m: 0.3 } as Item,
      { type: 'move', forward_m: 1.5 },
      { type: 'circle', ...plane_at(TARTU).from_plane({ east_m: 2, north_m: 0 }), radius_m: 4 },
    );
    const after = scale_items(run_between(0, 2), 2, TARTU)(before);
    expect(after.items.map((item) => item.type === 'move' && item.forward_m)[1]).toBe(3);
    expect(after.items[0]).toMatchObject({ radius_m: 0.3 });
    expect(after.items[2]).toMatchObject({ radius_m: 8 });
    expect(offset_between(TARTU, place(after, 2)).east_m).toBeCloseTo(4, 3);
  });

  test('that is mirrored about north changes left and right, and twice is as before', () => {
    const before = plan(
      point(3, 1),
      { type: 'turn', turn_deg: 30 },
      { type: 'turn', heading_deg: 80 },
      { type: 'wall', side: 'left', distance_m: 1 },
      point(-1, 2),
    );
    const all = run_between(0, 4);
    const after = mirror_items(all, 0, TARTU)(before);
    expect(after.items[1]).toEqual({ type: 'turn', turn_deg: -30 });
    expect(after.items[2]).toEqual({ type: 'turn', heading_deg: 280 });
    expect(after.items[3]).toMatchObject({ side: 'right' });
    expect(offset_between(TARTU, place(after, 0)).east_m).toBeCloseTo(-3, 3);
    expect(mirror_items(all, 0, TARTU)(after)).toEqual(before);
  });

  test('mirrored about the diagonal changes east and north', () => {
    const after = mirror_items(new Set([0]), 45, TARTU)(plan(point(7, 2)));
    expect(seen(after)).toEqual([[2, 7]]);
  });

  test('is made straight from its first to its last point', () => {
    const before = plan(point(0, 0), point(4, 3), point(10, 0));
    expect(seen(align_items(run_between(0, 2))(before))).toEqual([
      [0, 0],
      [4, 0],
      [10, 0],
    ]);
  });

  test('is laid beside itself: each leg so far off, also around a corner', () => {
    const before = plan(point(0, 0), point(0, 10), point(10, 10));
    // North, then east: to the right is inside of the corner.
    expect(seen(parallel_items(run_between(0, 2), 1)(before))).toEqual([
      [1, 0],
      [1, 9],
      [10, 9],
    ]);
    expect(seen(parallel_items(run_between(0, 2), -1)(before))).toEqual([
      [-1, 0],
      [-1, 11],
      [10, 11],
    ]);
  });

  test('that turns back on itself has no spike beyond four times the offset', () => {
    const before = plan(point(0, 0), point(0, 10), point(0.01, 0));
    const beside = seen(parallel_items(run_between(0, 2), 1)(before));
    for (const [east, north] of beside) {
      expect(Math.hypot(east, north - 10)).toBeLessThan(11);
    }
    const [, corner] = beside;
    expect(Math.hypot((corner?.[0] ?? 9) - 0, (corner?.[1] ?? 0) - 10)).toBeLessThanOrEqual(4.001);
  });

  test('changed by nothing is the plan itself', () => {
    const before = plan(point(0, 0), point(1, 1));
    expect(move_items(both, { east_m: 0, north_m: 0 })(before)).toBe(before);
    expect(rotate_items(both, 360, null)(before)).toBe(before);
    expect(scale_items(both, 1, null)(before)).toBe(before);
    expect(parallel_items(both, 0)(before)).toBe(before);
    expect(rotate_items(new Set(), 30, null)(before)).toBe(before);
  });
});

describe('a selection', () => {
  test('grows and shrinks by taps', () => {
    expect([...toggled(new Set([1, 4]), 4)]).toEqual([1]);
    expect([...run_between(5, 3)]).toEqual([3, 4, 5]);
  });

  test('follows its items, whatever their numbers are, and forgets what is gone', () => {
    const [a, b, c] = [point(0, 0), point(1, 0), point(2, 0)];
    const inserted = plan(a, point(0.5, 0), b, c);
    expect([...followed(new Set([0, 2, 3]), inserted, plan(a, b, c))]).toEqual([0, 1, 2]);
    expect([...followed(new Set([1, 2]), inserted, plan(a, b, c))]).toEqual([1]);
    // Turned round it is the same point; moved it stands where it stood.
    expect([...followed(new Set([0]), plan(a, b, c), plan(c, b, a))]).toEqual([2]);
    expect([...followed(new Set([1]), plan(a, b, c), plan(a, point(1, 5), c))]).toEqual([1]);
  });

  test('says what it is', () => {
    expect(picked_words(new Set([2]))).toBe('Item 3');
    expect(picked_words(run_between(2, 6))).toBe('Items 3 to 7');
    expect(picked_words(new Set([9, 1, 4]))).toBe('3 items from 2 to 10');
  });
});

test('a place far from the pivot is where the robot would put it', () => {
  const at = offset_from(TARTU, { east_m: 0, north_m: 1000 });
  expect(plane_at(TARTU).to_plane(at).north_m).toBeCloseTo(1000, 2);
});
