import { describe, expect, it } from 'vitest';

import { offset_between } from '../src/model/geo';
import type { Item, LatLon } from '../src/model/plan';
import { drawn_block, order_text, why_not_rows } from '../src/model/row_block';

const ENTRY: LatLon = { lat: 58.38, lon: 26.72 };

/** Two rows, the second to the right, driven back: as the robot plans them. */
const ROW: Item = { type: 'row' };
const right: Item = { type: 'turn', turn_deg: 90 };
const forward = (forward_m: number): Item => ({ type: 'move', forward_m });
const TWO: readonly Item[] = [
  { type: 'waypoint', ...ENTRY },
  { type: 'turn', heading_deg: 90 },
  ROW,
  forward(1.5),
  right,
  forward(2.5),
  right,
  ROW,
  forward(1.5),
];

const metres = (place: LatLon | undefined): readonly [east: number, north: number] => {
  const { east_m, north_m } = offset_between(ENTRY, place ?? { lat: 0, lon: 0 });
  return [Math.round(east_m * 100) / 100 + 0, Math.round(north_m * 100) / 100 + 0];
};

describe('a block of rows, as it is drawn', () => {
  it('leads along row 1, out of it, over to row 2 and back', () => {
    const { rows, way } = drawn_block(TWO, { at: ENTRY, heading_deg: 90 }, 10);
    expect(rows.map((row) => row.map(metres))).toEqual([
      [
        [0, 0],
        [10, 0],
      ],
      [
        [10, -2.5],
        [0, -2.5],
      ],
    ]);
    expect(way.map(metres)).toEqual([
      [0, 0],
      [10, 0],
      [11.5, 0],
      [11.5, -2.5],
      [0, -2.5],
      [-1.5, -2.5],
    ]);
  });

  it('needs no entry where the robot stands, and ends a row where it is told to', () => {
    const items = TWO.slice(2).map((item): Item =>
      item === ROW ? { type: 'row', distance_m: 4 } : item,
    );
    const { rows, way } = drawn_block(items, { at: ENTRY, heading_deg: 0 }, 10);
    expect(rows.map((row) => row.map(metres))).toEqual([
      [
        [0, 0],
        [0, 4],
      ],
      [
        [2.5, 5.5],
        [2.5, 1.5],
      ],
    ]);
    expect(metres(way.at(-1))).toEqual([2.5, 0]);
  });

  it('draws turns that are arcs as arcs', () => {
    const items: readonly Item[] = [
      ROW,
      forward(1.5),
      { type: 'turn', turn_deg: 180, radius_m: 1.25 },
      ROW,
    ];
    const { rows, way } = drawn_block(items, { at: ENTRY, heading_deg: 0 }, 10);
    expect(rows[1]?.map(metres)).toEqual([
      [2.5, 10],
      [2.5, 0],
    ]);
    const farthest = Math.max(...way.map((place) => metres(place)[1]));
    expect(farthest).toBeCloseTo(11.5 + 1.25, 2);
    expect(way.length).toBe(3 + 12 + 1);
  });

  it('says what is to be tapped next', () => {
    expect(why_not_rows(true, [])).toBe('Tap the map where row 1 begins.');
    expect(why_not_rows(true, [ENTRY])).toBe('Tap where row 1 ends.');
    expect(why_not_rows(true, [ENTRY, ENTRY])).toBeNull();
    expect(why_not_rows(false, [])).toBeNull();
  });

  it('tells the order, of many rows the first', () => {
    expect(order_text([1, 3, 5, 2, 4])).toBe('1 3 5 2 4');
    expect(order_text([1, 2, 3, 4], 2)).toBe('1 2 …');
  });
});
