import { describe, expect, test } from 'vitest';

import {
  area_places,
  area_size_m2,
  fresh_circle,
  NEW_FENCE,
  why_not_keep,
  with_places,
  type FenceArea,
} from '../src/model/fence';
import { offset_from } from '../src/model/geo';
import {
  add_place,
  area_m2,
  field_m2,
  insert_place,
  move_place,
  plan_of_places,
  remove_place,
} from '../src/model/outline';
import { area_text, share_text, why_not_survey, type SurveyWish } from '../src/model/survey';

const ORIGIN = { lat: 58.38, lon: 26.72 };
const at = (east_m: number, north_m: number) => offset_from(ORIGIN, { east_m, north_m });

//  3 ---- 2
//  |      |   30 m × 20 m
//  0 ---- 1
const RING = [at(0, 0), at(30, 0), at(30, 20), at(0, 20)];

describe('outline', () => {
  test('adds, inserts, moves and removes places, and leaves the old ones alone', () => {
    const before = RING.slice();
    expect(add_place(at(1, 1))(RING)).toHaveLength(5);
    expect(insert_place(1, at(15, -5))(RING)[2]).toEqual(RING[1]);
    expect(move_place(2, at(40, 20))(RING)[2]?.lon).toBeCloseTo(at(40, 20).lon, 8);
    expect(remove_place(0)(RING)).toEqual(RING.slice(1));
    expect(RING).toEqual(before);
  });

  test('what would change nothing gives the same places', () => {
    expect(move_place(9, ORIGIN)(RING)).toBe(RING);
    expect(remove_place(9)(RING)).toBe(RING);
  });

  test('knows its area, whichever way round it is drawn', () => {
    expect(area_m2(RING)).toBeCloseTo(600, 1);
    expect(area_m2(RING.toReversed())).toBeCloseTo(600, 1);
    expect(area_m2([])).toBe(0);
    expect(field_m2([RING, [at(5, 5), at(5, 10), at(15, 10), at(15, 5)], [at(1, 1)]])).toBeCloseTo(
      550,
      1,
    );
    expect(field_m2([])).toBe(0);
    expect(area_m2(RING.slice(0, 2))).toBe(0);
  });

  test('is drawn as waypoints', () => {
    expect(plan_of_places(RING).items).toHaveLength(4);
  });
});

describe('survey', () => {
  const wish = (corners: number) =>
    ({ polygon: RING.slice(0, corners), holes: [] }) as unknown as SurveyWish;

  test('needs three corners, and says how many are missing', () => {
    expect(why_not_survey(wish(0))).toContain('Tap the corners');
    expect(why_not_survey(wish(1))).toBe('2 more corners needed.');
    expect(why_not_survey(wish(2))).toBe('1 more corner needed.');
    expect(why_not_survey(wish(3))).toBeNull();
    const holes = [RING.slice(0, 3), RING.slice(0, 2)];
    expect(why_not_survey({ ...wish(3), holes })).toBe('Obstacle 2 needs three corners.');
  });

  test('never says that all is covered when it is not', () => {
    expect(share_text(0.99996)).toBe('99.9 %');
    expect(share_text(1)).toBe('100.0 %');
  });

  test('gives large areas in hectares', () => {
    expect(area_text(600)).toBe('600 m²');
    expect(area_text(12_500)).toBe('1.25 ha');
  });
});

describe('fence', () => {
  const polygon: FenceArea = { kind: 'inclusion', polygon: RING };

  test('a circle is taken by its middle and keeps its radius; the last tap counts', () => {
    const circle = fresh_circle('exclusion', at(5, 5));
    expect(area_places(circle)).toHaveLength(1);
    const moved = with_places(circle, [at(5, 5), at(9, 9)]);
    expect(moved.circle).toMatchObject({ radius_m: 5, lat: at(9, 9).lat });
    expect(area_size_m2(moved)).toBeCloseTo(78.5, 1);
  });

  test('an area of corners keeps its kind', () => {
    expect(with_places(polygon, RING.slice(1))).toEqual({
      kind: 'inclusion',
      polygon: RING.slice(1),
    });
  });

  test('is kept only with a name, whole areas and something in it', () => {
    expect(why_not_keep(NEW_FENCE)).toContain('Draw an area');
    const poor: FenceArea = { kind: 'exclusion', polygon: RING.slice(2) };
    expect(why_not_keep({ ...NEW_FENCE, areas: [polygon, poor] })).toBe(
      'Area 2 needs three corners.',
    );
    expect(why_not_keep({ ...NEW_FENCE, name: ' ', areas: [polygon] })).toContain('name');
    expect(why_not_keep({ ...NEW_FENCE, areas: [polygon] })).toBeNull();
    expect(why_not_keep({ ...NEW_FENCE, rally: [ORIGIN] })).toBeNull();
  });
});
