import { describe, expect, test } from 'vitest';

import { edge_spot } from '../src/model/edge';

//        100        300
//     50  ┌──────────┐
//         │    ·     │   · (200, 100)
//    150  └──────────┘
const box = { left: 100, top: 50, right: 300, bottom: 150 };

describe('what is out of sight', () => {
  test('is pointed to from the border, on the line from the middle', () => {
    expect(edge_spot(box, 500, 100)).toEqual({ x: 300, y: 100, angle_rad: 0 });
    expect(edge_spot(box, 200, 1100)).toEqual({ x: 200, y: 150, angle_rad: Math.PI / 2 });
    expect(edge_spot(box, 0, -100)).toEqual({
      x: 150,
      y: 50,
      angle_rad: Math.atan2(-200, -200),
    });
  });
  test('is nothing that can be seen, nor on a border, nor where there is no room', () => {
    expect(edge_spot(box, 299, 149)).toBeNull();
    expect(edge_spot(box, 300, 100)).toBeNull();
    expect(edge_spot({ ...box, right: 100 }, 500, 100)).toBeNull();
    expect(edge_spot(box, NaN, 100)).toBeNull();
    expect(edge_spot(box, Infinity, 100)).toBeNull();
  });
});
