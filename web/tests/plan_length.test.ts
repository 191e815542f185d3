import { expect, test } from 'vitest';

import { offset_from } from '../src/model/geo';
import { EMPTY_PLAN, type Item, type LatLon } from '../src/model/plan';
import { plan_length_m } from '../src/model/plan_length';

const START: LatLon = { lat: 58.378, lon: 26.729 };
const at = (east_m: number, north_m: number): LatLon => offset_from(START, { east_m, north_m });
const length = (...items: Item[]): number => plan_length_m({ ...EMPTY_PLAN, items });
const point = (east_m: number): Item => ({ type: 'waypoint', ...at(east_m, 0) });

test('a plan is as long as its legs, and its circles all the way round', () => {
  expect(length()).toBe(0);
  expect(length(point(0), { type: 'wait', seconds: 3 }, point(10))).toBeCloseTo(10, 2);
  const circle: Item = { type: 'circle', ...at(5, 0), radius_m: 3, turns: 2 };
  // Along the tangents: 4 of 5 metres to the middle, each way.
  expect(length(point(0), circle, point(10))).toBeCloseTo(4 + 12 * Math.PI + 4, 2);
  // From within, straight to its rim.
  expect(length(point(4), circle)).toBeCloseTo(2 + 12 * Math.PI, 2);
  expect(length({ type: 'circle', ...at(5, 0), radius_m: 3 })).toBeCloseTo(6 * Math.PI, 2);
});

test('of a plan that was changed in one place all the rest is as it was', () => {
  const items = [point(0), point(10), point(20), point(30)];
  expect(length(...items)).toBeCloseTo(30, 2);
  // One moved away to the side and back: both legs at it are others.
  expect(
    length(point(0), point(10), { ...point(20), ...at(20, 10) } as Item, point(30)),
  ).toBeCloseTo(10 + 2 * Math.hypot(10, 10), 2);
  // One taken out: the next one is come to from another.
  expect(length(...items.filter((_, k) => k !== 1))).toBeCloseTo(30, 2);
  const [first, , third] = items;
  expect(length(...(first && third ? [third, first, third] : []))).toBeCloseTo(40, 2);
  expect(length(...items)).toBeCloseTo(30, 2);
});

test('points of a map are as far apart as they are in it', () => {
  const spot = (x_m: number, y_m: number): Item => ({ type: 'map_point', x_m, y_m });
  expect(length(spot(1, 0), { type: 'wait', seconds: 3 }, spot(4, 4))).toBe(5);
  // What lies between the street and the map nobody knows.
  expect(length(spot(1, 0), point(0), spot(4, 4), spot(4, 6))).toBe(2);
});
