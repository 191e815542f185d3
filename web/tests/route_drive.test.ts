// How the loaded mission is to be driven: its speeds as they are set, and where it turns on the spot.

import { describe, expect, test } from 'vitest';

import { offset_from } from '../src/model/geo';
import type { WayPace, WayStop } from '../src/model/laid_way';
import type { Item, LatLon, Plan, Waypoint } from '../src/model/plan';
import {
  begin_heading,
  leg_speeds,
  pivots_ahead,
  pivots_of,
  speed_tags,
  told_pivots,
  told_speeds,
  type Pivot,
  type SpeedsSet,
} from '../src/model/route_drive';

const HOME: LatLon = { lat: 58.378, lon: 26.7289 };
const at = (east_m: number, north_m: number): LatLon => offset_from(HOME, { east_m, north_m });
const to = (east_m: number, north_m: number, more: Partial<Waypoint> = {}): Waypoint => ({
  type: 'waypoint',
  ...at(east_m, north_m),
  ...more,
});
const plan_of = (items: readonly Item[], more: Partial<Plan> = {}): Plan => ({
  name: 'Field',
  items,
  ...more,
});

const SET: SpeedsSet = { default_mps: 0.8, min_mps: 0.1, max_mps: 1.2, reverse_max_mps: 0.5 };

describe('the speed of the way to a place', () => {
  test('is its own, else that of the last speed item, the mission, the robot', () => {
    const items: Item[] = [
      to(0, 0),
      to(5, 0, { speed_mps: 0.4 }),
      { type: 'speed', speed_mps: 1 },
      to(10, 0),
      { type: 'wait', seconds: 1 },
      { type: 'circle', ...at(20, 0), radius_m: 3, speed_mps: 0.6 },
      { type: 'loiter', ...at(30, 0), seconds: 5 },
    ];
    expect(leg_speeds(plan_of(items), SET)).toEqual([0.8, 0.4, 1, 0.6, 1]);
    const slow = plan_of(items, { settings: { speed_mps: 0.3 } });
    expect(leg_speeds(slow, SET)).toEqual([0.3, 0.4, 1, 0.6, 1]);
  });

  test('is bounded by what the robot drives, less of it backwards', () => {
    const items = [
      to(0, 0, { speed_mps: 3 }),
      to(5, 0, { speed_mps: 3, reverse: true }),
      to(9, 0, { speed_mps: 0.01 }),
    ];
    expect(leg_speeds(plan_of(items), SET)).toEqual([1.2, 0.5, 0.1]);
  });

  test('is not guessed', () => {
    const items = [to(0, 0), to(5, 0, { speed_mps: 0.4 }), to(9, 0, { reverse: true })];
    expect(leg_speeds(plan_of(items), { ...SET, default_mps: null })).toEqual([null, 0.4, null]);
    expect(leg_speeds(plan_of(items), { ...SET, reverse_max_mps: null })).toEqual([0.8, 0.4, null]);
    expect(leg_speeds(plan_of(items), { ...SET, max_mps: null })).toEqual([null, null, 0.5]);
  });
});

describe('a speed is written on the map', () => {
  test('where another one begins, in the unit that was chosen', () => {
    expect(speed_tags([1, 0.8, 0.8, 0.45, 0.45, 0.8], 'm/s')).toEqual([
      { k: 1, text: '0.8 m/s' },
      { k: 3, text: '0.45 m/s' },
      { k: 5, text: '0.8 m/s' },
    ]);
    expect(speed_tags([1, 0.8, 0.5], 'km/h').map(({ text }) => text)).toEqual([
      '2.9 km/h',
      '1.8 km/h',
    ]);
  });

  test('nowhere where all of the way has one, and not where nobody knows', () => {
    expect(speed_tags([1, 0.8, 0.8], 'm/s')).toEqual([]);
    expect(speed_tags([0.8, null, null], 'm/s')).toEqual([]);
    expect(speed_tags([0.8, null, 0.8], 'm/s')).toEqual([{ k: 2, text: '0.8 m/s' }]);
    expect(speed_tags([], 'm/s')).toEqual([]);
  });
});

/** As the robot lays a way whose corners are all sharp. */
const sharp = (plan: Plan): LatLon[] =>
  plan.items.flatMap((item) =>
    item.type === 'waypoint' ? [{ lat: item.lat, lon: item.lon }] : [],
  );
const TANK = { kinematics: 'skid_steer', pivot_angle_deg: 30 };
const turns = (items: readonly Item[], way?: readonly LatLon[]): readonly Pivot[] => {
  const plan = plan_of(items);
  return pivots_of(plan, way ?? sharp(plan), TANK);
};
const told = (found: readonly Pivot[]): string[] =>
  found.map(({ index, left }) => `${index + 1} ${left ? 'left' : 'right'}`);

describe('it turns on the spot', () => {
  test('at corners that are sharp enough, or that ask for it', () => {
    const gentle = [to(0, 0), to(10, 0), to(20, 4), to(30, 4)];
    expect(told(turns([to(0, 0), to(10, 0), to(10, 10), to(20, 10)]))).toEqual([
      '2 left',
      '3 right',
    ]);
    expect(turns(gentle)).toEqual([]); // 22 degrees
    const asked = gentle.map((each, k) => (k === 1 ? { ...each, turn: 'pivot' as const } : each));
    expect(told(turns(asked))).toEqual(['2 left']);
    const arc = [to(0, 0), to(10, 0, { turn: 'arc' }), to(10, 10)];
    expect(turns(arc)).toEqual([]);
  });

  test('where the way as it is laid has that corner, not where it is rounded or smoothed', () => {
    const items = [to(0, 0), to(10, 0), to(10, 10)];
    const rounded = [at(0, 0), at(9, 0), at(9.7, 0.3), at(10, 1), at(10, 10)];
    expect(turns(items, rounded)).toEqual([]);
    expect(told(turns(items, [at(0, 0), at(10, 0), at(10, 5), at(10, 10)]))).toEqual(['2 left']);
    // A crossing of two straights at the place is no corner.
    const crossing = [at(0, 0), at(10, 0), at(20, 0), at(10, 10), at(10, 0)];
    expect(turns(items, crossing)).toEqual([]);
    expect(turns(items, [])).toEqual([]); // not known yet
  });

  test('not with steered wheels', () => {
    const plan = plan_of([to(0, 0), to(10, 0), to(10, 10)]);
    expect(pivots_of(plan, sharp(plan), { ...TANK, kinematics: 'ackermann' })).toEqual([]);
  });

  test('by how it faces: back the same way in reverse needs none', () => {
    const back = (reverse: boolean) => [to(0, 0), to(10, 0), to(4, 0, { reverse })];
    expect(turns(back(true))).toEqual([]);
    expect(told(turns(back(false)))).toHaveLength(1);
    // Out of the reverse leg it goes on forwards, to the side.
    const on = [to(0, 0), to(10, 0), to(4, 0, { reverse: true }), to(4, 9)];
    expect(told(turns(on))).toEqual(['3 left']);
  });

  test('for an item that says so, clockwise positive, once at each place', () => {
    const straight = [to(0, 0), to(10, 0)];
    expect(told(turns([...straight, { type: 'turn', turn_deg: 90 }]))).toEqual(['2 right']);
    expect(told(turns([...straight, { type: 'turn', heading_deg: 0 }]))).toEqual(['2 left']);
    const both: Item[] = [...straight, { type: 'turn', turn_deg: -90 }, to(20, 0)];
    expect(told(turns(both))).toEqual(['2 left']);
  });

  test('where a plan tells it: not behind what has no place, nor where it begins', () => {
    const move: Item = { type: 'move', forward_m: 3 };
    expect(
      turns([to(0, 0), to(10, 0), move, to(10, 10), to(0, 10)]).map(({ index }) => index),
    ).toEqual([]);
    expect(turns([to(0, 0), { type: 'turn', turn_deg: 90 }])).toEqual([]);
  });

  test('off a circle, from where it ends', () => {
    // Entered from the south along its tangent at the east, and left there to the east.
    const items: Item[] = [
      to(5, -10),
      { type: 'circle', ...at(0, 0), radius_m: 5, turns: 1 },
      to(15, 0),
    ];
    const round = Array.from({ length: 73 }, (_, k) => {
      const angle = (k * Math.PI) / 36;
      return at(5 * Math.cos(angle), 5 * Math.sin(angle));
    });
    expect(told(turns(items, [at(5, -10), ...round, at(15, 0)]))).toEqual(['2 right']);
  });

  test('and its mark is outside of the corner', () => {
    const [corner] = turns([to(0, 0), to(10, 0), to(10, 10)]);
    expect(((corner?.outside_rad ?? 0) * 180) / Math.PI).toBeCloseTo(-45, 0);
    const [end] = turns([to(0, 0), to(10, 0), to(2, 0)]);
    expect(Math.abs(end?.outside_rad ?? 9)).toBeLessThan(0.01);
  });

  test('what is done is told no more', () => {
    const all = turns([to(0, 0), to(10, 0), to(10, 10), to(20, 10)]);
    expect(told(pivots_ahead(all, 0))).toEqual(['2 left', '3 right']);
    expect(told(pivots_ahead(all, 2))).toEqual(['2 left', '3 right']);
    expect(told(pivots_ahead(all, 3))).toEqual(['3 right']);
  });
});

describe('what the robot tells of the way that it laid', () => {
  const places = [at(0, 0), at(0, 1), at(0, 10), at(10, 10)];
  const told_pace = (sets: readonly number[]): WayPace[] =>
    places.map((place, k) => ({
      ...place,
      distance_m: [0, 1, 10, 20][k] ?? 0,
      speed_mps: 0,
      set_mps: sets[k] ?? 0,
      item: k < 2 ? 2 : 3,
    }));
  const stop = (k: number, item: number, turns: WayStop['turns']): WayStop => ({
    ...(places[k] ?? HOME),
    distance_m: [0, 1, 10, 20][k] ?? 0,
    item,
    turns,
  });
  const from_there = {
    from_heading_deg: 0,
    to_heading_deg: 90,
    turn_deg: 90,
    above_deg: 0,
  };
  const begin = { from_heading_deg: null, to_heading_deg: 0, turn_deg: null, above_deg: 30 };

  test('goes before what the items ask for, and leaves the rest as it was', () => {
    const plan = plan_of([to(0, 0), to(0, 10, { speed_mps: 1.1 }), to(10, 10), to(20, 10)]);
    expect(told_speeds(plan, SET, told_pace([0.4, 0.7, 0.3, 9]))).toEqual([0.8, 0.7, 0.3, 0.8]);
  });

  test('a turn at a corner stands outside of it', () => {
    const [turn, ...more] = told_pivots([stop(2, 2, [from_there])], told_pace([]), null);
    expect(more).toEqual([]);
    expect([turn?.index, turn?.left]).toEqual([1, false]);
    expect(((turn?.outside_rad ?? 0) * 180) / Math.PI).toBeCloseTo(135, 0);
  });

  test('where it begins it turns only if it points away by more', () => {
    const lefts = (begin_deg: number | null): readonly boolean[] =>
      told_pivots([stop(0, 1, [begin])], told_pace([]), begin_deg).map(({ left }) => left);
    expect(lefts(null)).toEqual([]);
    expect(lefts(20)).toEqual([]);
    expect(lefts(90)).toEqual([true]);
    expect(lefts(300)).toEqual([false]);
    // Behind an item without a place nobody knows.
    expect(told_pivots([stop(0, 1, []), stop(2, 2, [begin])], told_pace([]), 90)).toEqual([]);
  });

  test('it stands at the begin, or nobody knows how it will come there', () => {
    const stops = [stop(0, 1, [begin])];
    expect(begin_heading(stops, { ...at(0.5, 0), heading_deg: 93 })).toBe(90);
    expect(begin_heading(stops, { ...at(0, 0), heading_deg: 359 })).toBe(0);
    expect(begin_heading(stops, { ...at(3, 0), heading_deg: 93 })).toBeNull();
    expect(begin_heading(stops, { ...at(0, 0), heading_deg: null })).toBeNull();
    expect(begin_heading([], { ...at(0, 0), heading_deg: 1 })).toBeNull();
  });
});
