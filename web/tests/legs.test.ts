import { expect, test } from 'vitest';

import { turn_at } from '../src/model/legs';

test('a turn is told as a turn item is: to the right positive', () => {
  const north = [
    [0, 0],
    [0, 1],
  ] as const;
  const to = (x: number, y: number) =>
    turn_at(north, [
      [0, 1],
      [x, y],
    ]);
  expect(to(1, 1)).toBeCloseTo(90);
  expect(to(-1, 1)).toBeCloseTo(-90);
  expect(to(1, 2)).toBeCloseTo(45);
  expect(to(0, 2)).toBeCloseTo(0);
  expect(Math.abs(to(0, 0) ?? 0)).toBeCloseTo(180);
  expect(to(0, 1)).toBeNull();
});
