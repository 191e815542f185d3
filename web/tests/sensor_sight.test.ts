// What one sensor sees, as its card shows it.

import { expect, test } from 'vitest';

import type { SeenScan, Sensor } from '../src/model/seen';
import { sight_of, sight_words } from '../src/model/sensor_sight';

/** On the left front corner, turned 30° to the left. */
const front = {
  name: 'front',
  mount: { x_m: 0.5, y_m: 0.3, z_m: 0.3, roll_deg: 0, pitch_deg: 0, yaw_deg: 30 },
} as Sensor;
const scan = (obstacle_cm: readonly number[], age_s = 0.05): SeenScan => ({
  age_s,
  at: null,
  sensors: [
    { sensor: 'top', age_s, obstacle_cm: [100, 0], overhang_cm: [], drop_cm: [], passing_cm: [] },
    { sensor: 'front', age_s, obstacle_cm, overhang_cm: [], drop_cm: [], passing_cm: [] },
  ],
});

test('ahead is up and left is left, from the robot’s middle; of its own dots alone', () => {
  const sight = sight_of(front, scan([400, 0, 300, 100]));
  expect(sight?.dots.obstacle).toEqual([
    [-0, -4],
    [-1, -3],
  ]);
  expect(sight).toMatchObject({ mount: [-0.3, -0.5], looks_deg: -30, reach_m: 5 });
  expect(sight_words(sight)).toBe(
    '2 points, the nearest 3.16 m from the robot. The outer ring is at 5.00 m; up is ahead.',
  );
});

test('one dot far away does not shrink the rest', () => {
  const near = Array.from({ length: 9 }, () => [100, 50]).flat();
  expect(sight_of(front, scan([...near, 3500, 0]))?.reach_m).toBe(2);
});

test('what is old, or of a sensor that says nothing, is no picture of now', () => {
  expect(sight_of(front, scan([400, 0], 1.1))).toBeNull();
  expect(sight_of({ ...front, name: 'rear' }, scan([400, 0]))).toBeNull();
  expect(sight_of(front, null)).toBeNull();
  expect(sight_words(null)).toBe('It tells nothing just now.');
  expect(sight_words(sight_of(front, scan([])))).toBe('It sees nothing that stands there.');
});
