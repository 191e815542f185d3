import { describe, expect, test } from 'vitest';

import { draw_thinned, THIN_PX, type Frame } from '../src/model/thinned';

type At = readonly [number, number];
const SCREEN: Frame = { left: 0, top: 0, right: 100, bottom: 100 };

/** The pieces that are drawn. */
const drawn = (line: readonly At[], frame = SCREEN): At[][] => {
  const pieces: At[][] = [];
  const pen = {
    moveTo: (x: number, y: number) => void pieces.push([[x, y]]),
    lineTo: (x: number, y: number) => void pieces.at(-1)?.push([x, y]),
  };
  const points = {
    x_px: (k: number) => line[k]?.[0] ?? NaN,
    y_px: (k: number) => line[k]?.[1] ?? NaN,
  };
  draw_thinned(pen, points, frame, 0, line.length);
  return pieces;
};

/** How far a place is from the nearest of some legs. */
const off = ([x, y]: At, line: readonly At[]): number =>
  Math.min(
    ...line.slice(1).map(([bx, by], k) => {
      const [ax, ay] = line[k] ?? [0, 0];
      const [dx, dy] = [bx - ax, by - ay];
      const along = ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1);
      const at = Math.max(0, Math.min(1, along));
      return Math.hypot(x - ax - at * dx, y - ay - at * dy);
    }),
  );

describe('a line as a screen shows it', () => {
  test('points on a straight line are left out, corners stay', () => {
    const line: At[] = [...Array(21).keys()].map((k): At => [2 * k, 10]);
    const corner: At[] = [...line, [40, 50], [40, 90]];
    expect(drawn(corner)).toEqual([
      [
        [0, 10],
        [40, 10],
        [40, 90],
      ],
    ]);
  });

  test('a bend of thousands of points needs few, and they pass all of them near enough', () => {
    const bend = [...Array(3000).keys()].map((k): At => {
      const angle = (k / 3000) * 2 * Math.PI;
      return [50 + 40 * Math.cos(angle), 50 + 30 * Math.sin(2 * angle)];
    });
    const [piece = []] = drawn(bend);
    expect(piece.length).toBeLessThan(90);
    expect(piece[0]).toEqual(bend[0]);
    expect(piece.at(-1)).toEqual(bend.at(-1));
    expect(Math.max(...bend.map((at) => off(at, piece)))).toBeLessThan(2 * THIN_PX);
  });

  test('a way back over itself reaches its far end', () => {
    const there_and_back: At[] = [
      [10, 10],
      [50, 10],
      [90, 10],
      [50, 10],
      [30, 10],
    ];
    expect(drawn(there_and_back)).toEqual([
      [
        [10, 10],
        [90, 10],
        [30, 10],
      ],
    ]);
  });

  test('what lies outside is left out, and where the line comes in again another piece begins', () => {
    const out_and_in: At[] = [
      [50, 50],
      [50, 150],
      [70, 170],
      [90, 150],
      [90, 50],
    ];
    expect(drawn(out_and_in)).toEqual([
      [
        [50, 50],
        [50, 150],
      ],
      [
        [90, 150],
        [90, 50],
      ],
    ]);
  });

  test('a leg whose ends both lie outside may cross the screen', () => {
    expect(
      drawn([
        [-10, 50],
        [110, 50],
      ]),
    ).toHaveLength(1);
    expect(
      drawn([
        [-10, 50],
        [-10, 90],
      ]),
    ).toEqual([]);
  });

  test('a single point and none draw nothing', () => {
    expect(drawn([[50, 50]])).toEqual([]);
    expect(drawn([])).toEqual([]);
  });
});
