import { describe, expect, test } from 'vitest';

import { circle_way } from '../src/model/circle';

const wish = { radius: 3, clockwise: false, turns: 1, on: 0.2 };

describe('the way onto a circle', () => {
  test('is its tangent from outside, at the side of the turn', () => {
    // 5 below the centre; the tangent's length is 4.
    for (const clockwise of [false, true]) {
      const { from_rad, tangent } = circle_way({ ...wish, clockwise }, [0, -5]);
      const [x, y] = [3 * Math.cos(from_rad), 3 * Math.sin(from_rad)];
      expect(tangent).toBe(true);
      expect(Math.hypot(x, y + 5)).toBeCloseTo(4, 9);
      expect(x * x + y * (y + 5)).toBeCloseTo(0, 9); // at right angles to the radius
      expect(Math.sign(x)).toBe(clockwise ? -1 : 1);
    }
  });

  test('is the nearest place from inside, and north from nowhere known', () => {
    expect(circle_way(wish, [-1, 0])).toMatchObject({ from_rad: Math.PI, tangent: false });
    expect(circle_way(wish, null).from_rad).toBeCloseTo(Math.PI / 2, 9);
    expect(circle_way(wish, [0, 0]).from_rad).toBeCloseTo(Math.PI / 2, 9);
  });

  test('goes round as often as it is told', () => {
    expect(circle_way({ ...wish, turns: 2.5 }, null).sweep_rad).toBeCloseTo(5 * Math.PI, 9);
    const right = circle_way({ ...wish, turns: 0.5, clockwise: true }, null);
    expect(right.sweep_rad).toBeCloseTo(-Math.PI, 9);
  });
});
