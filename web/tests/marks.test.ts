import { describe, expect, it } from 'vitest';

import { mark_rows, type KnownMarks } from '../src/model/marks';

const NOTHING: KnownMarks = { landmarks: [], walls: [], tags: [], obstacles: [], planes: [] };

describe('the table of landmarks, walls and tags', () => {
  it('says what stands where, how sure that is, who saw it and how long ago', () => {
    const [cone, wall, tag, thing, plane] = mark_rows({
      landmarks: [
        {
          id: 7,
          name: 'cone',
          ahead_m: 3.2,
          left_m: -0.9,
          sigma_m: 0.04,
          radius_m: null,
          source: 'both',
          believed: true,
          age_s: 0.2,
        },
      ],
      walls: [
        {
          id: 2,
          source: 'scan',
          believed: false,
          distance_m: 0.9,
          from: { ahead_m: -1, left_m: 0.9 },
          to: { ahead_m: 5, left_m: 0.9 },
          sigma_m: 0.02,
          age_s: 1,
        },
      ],
      tags: [{ id: 4, ahead_m: -2, left_m: 0, sigma_m: 0.01, camera: 'front', age_s: 75 }],
      obstacles: [{ sensor: 'left', ahead_m: 1, left_m: 1, age_s: 0.1 }],
      planes: [{ sensor: 'left', ahead_m: 2, left_m: 0.5, size: 900, age_s: 0.1 }],
    });
    expect(cone).toEqual({
      key: 'l7',
      what: 'cone',
      where: '3.20 m ahead, 0.90 m right ±4.0 cm',
      by: 'both',
      age: '0.2 s',
      believed: true,
    });
    expect(wall).toMatchObject({
      what: 'Wall 2, 6.00 m',
      where: '0.90 m ±2.0 cm',
      believed: false,
    });
    expect(tag).toMatchObject({ what: 'Tag 4', by: 'front', age: '75 s', believed: null });
    expect(tag?.where).toContain('2.00 m behind');
    expect(thing?.what).toBe('Obstacle');
    expect(plane?.what).toBe('Plane of 900 points');
  });

  it('names a landmark that nobody named by its number, and is empty of nothing', () => {
    expect(mark_rows(NOTHING)).toEqual([]);
    const [mark] = mark_rows({
      ...NOTHING,
      landmarks: [
        {
          id: 12,
          name: null,
          ahead_m: 1,
          left_m: 1,
          sigma_m: 0.1,
          radius_m: 0.1,
          source: 'scan',
          believed: false,
          age_s: 1,
        },
      ],
    });
    expect(mark?.what).toBe('Landmark 12');
  });
});
