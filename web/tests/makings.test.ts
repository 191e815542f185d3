import { describe, expect, it } from 'vitest';

import {
  drawing_in,
  drawing_of,
  drawn_on_map,
  making_of,
  mark_of,
  parse_makings,
  same_drawn,
  with_making,
  type DrawnField,
  type DrawnRows,
} from '../src/model/makings';
import type { Item, KeptDrawing, LatLon } from '../src/model/plan';

const corners: readonly LatLon[] = [58, 58.001, 58.002].map((lat) => ({ lat, lon: 26 }));
const field = (spacing_m: number): DrawnField => ({
  kind: 'survey',
  wish: {
    polygon: corners,
    holes: [],
    pattern: 'tracks',
    spacing_m,
    direction_deg: null,
    turn: 'pivot',
    radius_m: 2,
    headland_passes: 1,
    speed_mps: null,
  },
});
const [at = { lat: 0, lon: 0 }, toward = at] = corners;
const rows: DrawnRows = {
  kind: 'rows',
  places: [at, toward],
  wish: {
    rows: 2,
    spacing_m: 2.5,
    turn: 'right',
    skip: 0,
    out_m: 1.5,
    turn_kind: 'auto',
    radius_m: null,
    alternating: true,
    to: null,
    entry: { at, heading_deg: 0 },
    side: 'both',
    gap_m: null,
    speed_mps: null,
    distance_m: null,
    seeing: 'line',
  },
};
const points = (...lats: readonly number[]): Item[] =>
  lats.map((lat) => ({ type: 'waypoint', lat, lon: 26 }));

it('is the same drawing in whatever order its words stand, and another one by one number', () => {
  const { polygon, holes, ...others } = field(2).wish;
  const kept: DrawnField = { wish: { ...others, holes, polygon }, kind: 'survey' };
  expect(same_drawn(kept, field(2))).toBe(true);
  expect(same_drawn({ ...kept, ...{ mark: '2-77' } }, field(2))).toBe(true);
  expect(same_drawn(field(2), field(2.5))).toBe(false);
  expect(same_drawn(rows, { ...rows, places: [toward, at] })).toBe(false);
  expect(same_drawn(rows, { ...rows, wish: { ...rows.wish, entry: null } })).toBe(false);
  expect(same_drawn(rows, field(2))).toBe(false);
});

describe('what the robot keeps of a drawing', () => {
  const kept = drawing_of(field(2), points(1, 2));

  it('is drawn on with by whoever has the mission, and tells what was changed by hand since', () => {
    expect(kept).toMatchObject({ kind: 'survey' });
    const text = JSON.parse(JSON.stringify(kept)) as KeptDrawing;
    const plan = { name: 'Field', items: points(1, 2), drawing: text };
    expect(drawing_in(plan)).toMatchObject({ drawn: field(2), by_hand: false });
    expect(drawing_in({ ...plan, items: points(1, 2, 3) })?.by_hand).toBe(true);
  });

  it('is none of what is too large, another one’s or damaged', () => {
    const large = { ...field(1), wish: { ...field(1).wish, polygon: Array(4000).fill(at) } };
    expect(drawing_of(large, points(1))).toBeNull();
    const plan = { name: 'Field', items: points(1) };
    expect(drawing_in(plan)).toBeNull();
    for (const drawing of [null, { kind: 'poem' }, { kind: 'survey' }, { kind: 'rows', wish: {} }])
      expect(drawing_in({ ...plan, drawing })).toBeNull();
  });
});

describe('what a mission was made of', () => {
  const makings = with_making(
    with_making([], { id: 'a', mark: mark_of(points(1, 2, 3)), drawn: field(1) }),
    { id: 'a', mark: mark_of(points(1, 2)), drawn: field(2) },
  );

  it('is found by its points, also after an undo; in whatever order their fields stand', () => {
    expect(making_of(makings, 'a', points(1, 2))).toEqual({ drawn: field(2), by_hand: false });
    const undone: Item[] = [1, 2, 3].map((lat) => ({
      lon: 26,
      lat,
      type: 'waypoint',
      hold_s: null,
    }));
    expect(making_of(makings, 'a', undone)).toEqual({ drawn: field(1), by_hand: false });
  });

  it('is the newest where points were changed by hand, in their order too', () => {
    expect(making_of(makings, 'a', points(1, 2.5))).toEqual({ drawn: field(2), by_hand: true });
    expect(making_of(makings, 'a', points(2, 1))?.by_hand).toBe(true);
    expect(making_of(makings, 'b', points(1, 2))).toBeNull();
  });

  it('is kept once for the same points, ten times for one mission, for sixty in all', () => {
    let all = makings;
    for (let k = 0; k < 30; k += 1) all = with_making(all, { id: 'a', mark: `${k}`, drawn: rows });
    expect(all.map(({ mark }) => mark)).toEqual(
      [29, 28, 27, 26, 25, 24, 23, 22, 21, 20].map(String),
    );
    for (let k = 0; k < 80; k += 1) all = with_making(all, { id: `${k}`, mark: '', drawn: rows });
    expect(all).toHaveLength(60);
    expect(
      with_making(makings, { id: 'a', mark: mark_of(points(1, 2)), drawn: rows }),
    ).toHaveLength(2);
  });

  it('is read again as it was kept; what is damaged is left out', () => {
    const all = with_making(makings, { id: 'c', mark: '', drawn: rows });
    expect(parse_makings(JSON.stringify(all))).toEqual(all);
    expect(parse_makings('[')).toEqual([]);
    const made = { id: 'a', mark: '', drawn: rows };
    const bad = [
      { ...made, id: 1 },
      { ...made, drawn: { ...rows, kind: 'circle' } },
      { ...made, drawn: { ...rows, places: [{ lat: 1 }] } },
      { ...made, drawn: { ...rows, wish: { ...rows.wish, entry: { at: null } } } },
      { ...made, drawn: { kind: 'survey', wish: { ...field(1).wish, polygon: null } } },
      { ...made, drawn: { kind: 'survey', wish: { ...field(1).wish, holes: [1] } } },
      made,
    ];
    expect(parse_makings(JSON.stringify(bad))).toEqual([made]);
  });

  it('is on the map as its closed border, or as the way through the rows', () => {
    expect(drawn_on_map(field(1), [])).toEqual([{ places: [...corners, at], tone: 'drawn' }]);
    const [line] = drawn_on_map(rows, [{ type: 'row' }, { type: 'move', forward_m: 1.5 }]);
    expect(line?.places).toHaveLength(3);
    expect(line?.places[1]?.lat).toBeCloseTo(toward.lat, 6); // as long as it was drawn
    const here = { ...rows, wish: { ...rows.wish, entry: null } };
    expect(drawn_on_map(here, [{ type: 'row' }])).toEqual([]);
  });
});
