import { describe, expect, it } from 'vitest';

import { offset_from } from '../src/model/geo';
import { measured } from '../src/model/measure';

const ORIGIN = { lat: 58.378062, lon: 26.728779 };
const at = (east_m: number, north_m: number) => offset_from(ORIGIN, { east_m, north_m });

describe('a measured line', () => {
  it('has a length and a bearing for every leg, and no area while it is a line', () => {
    const { legs, length_m, ring } = measured([at(0, 0), at(0, 30)]);
    expect(legs).toHaveLength(1);
    expect(legs[0]?.length_m).toBeCloseTo(30, 2);
    expect(legs[0]?.bearing_deg).toBeCloseTo(0, 2);
    expect(length_m).toBeCloseTo(30, 2);
    expect(ring).toBeNull();
  });

  it('encloses an area once it has three points', () => {
    const { legs, length_m, ring } = measured([at(0, 0), at(40, 0), at(40, -30)]);
    expect(legs.map((leg) => Math.round(leg.bearing_deg))).toEqual([90, 180]);
    expect(length_m).toBeCloseTo(70, 1);
    expect(ring?.around_m).toBeCloseTo(120, 1);
    expect(ring?.area_m2).toBeCloseTo(600, 0);
  });

  it('is nothing of nothing, and of a single place', () => {
    expect(measured([])).toEqual({ legs: [], length_m: 0, ring: null });
    expect(measured([at(1, 1)]).length_m).toBe(0);
  });
});
