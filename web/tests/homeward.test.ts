import { describe, expect, test } from 'vitest';

import type { Fence } from '../src/model/fence';
import { offset_from } from '../src/model/geo';
import { refuge } from '../src/model/homeward';
import type { LatLon } from '../src/model/plan';

const HERE: LatLon = { lat: 58, lon: 26 };
const at = (east_m: number, north_m: number): LatLon => offset_from(HERE, { east_m, north_m });
const fence = (given: Partial<Fence>): Fence => ({
  id: 'f',
  revision: 1,
  active: true,
  name: 'Field',
  areas: [],
  rally: [],
  ...given,
});

describe('the way home', () => {
  test('leads to home, with its distance and direction', () => {
    const found = refuge(at(30, 40), null, HERE);
    expect(found).toMatchObject({ name: 'Home' });
    expect(found?.distance_m).toBeCloseTo(50, 2);
    expect(found?.bearing_deg).toBeCloseTo(36.87, 1);
    expect(refuge(null, null, HERE)).toBeNull();
    expect(refuge(null, fence({}), HERE)).toBeNull();
  });

  test('leads to a rally point that is nearer', () => {
    const rally = [at(0, 80), at(0, -20)];
    expect(refuge(at(30, 40), fence({ rally }), HERE)?.name).toBe('Rally point 2');
    expect(refuge(null, fence({ rally }), HERE)?.name).toBe('Rally point 2');
    expect(refuge(at(0, 5), fence({ rally }), HERE)?.name).toBe('Home');
  });

  //   home
  //   ┌──────┐  keep out
  //   └──────┘
  //    robot          rally
  test('never across the limit of an area, be it a polygon or a circle', () => {
    const polygon = [at(-5, 10), at(5, 10), at(5, 15), at(-5, 15)];
    const rally = [at(60, 0)];
    const areas = [{ kind: 'exclusion', polygon } as const];
    expect(refuge(at(0, 30), fence({ areas, rally }), HERE)?.name).toBe('Rally point 1');
    expect(refuge(at(0, 30), fence({ areas }), HERE)).toBeNull();
    expect(refuge(at(0, 9), fence({ areas }), HERE)?.name).toBe('Home');
    const circle = { ...at(0, 15), radius_m: 4 };
    const round = [{ kind: 'exclusion', circle } as const];
    expect(refuge(at(0, 30), fence({ areas: round }), HERE)).toBeNull();
    expect(refuge(at(0, 10), fence({ areas: round }), HERE)?.name).toBe('Home');
    expect(refuge(at(10, 30), fence({ areas: round }), HERE)?.name).toBe('Home');
    const around = [{ kind: 'inclusion', circle: { ...HERE, radius_m: 50 } } as const];
    expect(refuge(at(0, 30), fence({ areas: around }), HERE)?.name).toBe('Home');
    expect(refuge(at(0, 60), fence({ areas: around }), HERE)).toBeNull();
  });
});
