import { describe, expect, test } from 'vitest';

import {
  bearing_deg,
  distance_m,
  length_m,
  midpoint,
  offset_between,
  offset_from,
  radian_m,
  round_step_above,
  round_step_below,
  rounded,
} from '../src/model/geo';

describe('geo', () => {
  test('agrees with a worked example on the WGS84 ellipsoid', () => {
    // From 44.4928351 N 11.3300422 E to 44.4926007 N 11.3301258 E: 26.04 m south, 6.65 m east.
    const offset = offset_between(
      { lat: 44.4928351, lon: 11.3300422 },
      { lat: 44.4926007, lon: 11.3301258 },
    );
    expect(offset.north_m).toBeCloseTo(-26.0467, 2);
    expect(offset.east_m).toBeCloseTo(6.65, 2);
    expect(radian_m(44.4928351).north).toBeCloseTo(6_366_814 - 113.2, -3);
  });

  test('an offset and back is the same place, also over the date line', () => {
    for (const from of [
      { lat: 58.37802, lon: 26.7289 },
      { lat: -35.3, lon: 149.1 },
      { lat: 0, lon: 179.9999 },
    ]) {
      const to = offset_from(from, { east_m: 850, north_m: -1200 });
      const back = offset_between(from, to);
      expect(back.east_m).toBeCloseTo(850, 3);
      expect(back.north_m).toBeCloseTo(-1200, 3);
    }
    expect(distance_m({ lat: 0, lon: 179.9999 }, { lat: 0, lon: -179.9999 })).toBeCloseTo(22.26, 1);
    // A quarter of the equator of WGS84 is 10,018.754 km: half a percent is enough so far away.
    expect(distance_m({ lat: 0, lon: 100 }, { lat: 0, lon: -170 }) / 10_018_754).toBeCloseTo(1, 2);
    // Over the pole it is 2 degrees of a meridian.
    expect(distance_m({ lat: 89, lon: 0 }, { lat: 89, lon: 180 }) / 223_388).toBeCloseTo(1, 2);
    expect(midpoint({ lat: 0, lon: 179 }, { lat: 0, lon: -179 }).lon).toBeCloseTo(180, 9);
  });

  test('bearings are compass degrees', () => {
    const here = { lat: 58, lon: 26 };
    const to = (east_m: number, north_m: number) =>
      bearing_deg(here, offset_from(here, { east_m, north_m }));
    expect(to(0, 10)).toBeCloseTo(0, 3);
    expect(to(10, 0)).toBeCloseTo(90, 3);
    expect(to(0, -10)).toBeCloseTo(180, 3);
    expect(to(-10, 0)).toBeCloseTo(270, 3);
  });

  test('a length is the sum of its legs; nothing and one point have none', () => {
    const here = { lat: 58, lon: 26 };
    const line = [here, offset_from(here, { east_m: 3, north_m: 0 }), here];
    expect(length_m(line)).toBeCloseTo(6, 4);
    expect(length_m([here])).toBe(0);
    expect(length_m([])).toBe(0);
  });

  test('steps are 1, 2, 5 times a power of ten', () => {
    expect([0.7, 1, 1.9, 2, 4.9, 5, 99].map(round_step_below)).toEqual([0.5, 1, 1, 2, 2, 5, 50]);
    expect([0.7, 1, 1.1, 2, 2.1, 5, 51].map(round_step_above)).toEqual([1, 1, 2, 2, 5, 5, 100]);
  });

  test('rounding keeps nine decimals', () => {
    expect(rounded({ lat: 58.1234567894, lon: -26.9876543216 })).toEqual({
      lat: 58.123456789,
      lon: -26.987654322,
    });
  });
});
