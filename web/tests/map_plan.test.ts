import { describe, expect, test } from 'vitest';

import { offset_between } from '../src/model/geo';
import {
  drag_there,
  drawn_plan,
  insert_there,
  map_of_plan,
  middle_of_map,
  move_there,
  type PlanMap,
} from '../src/model/map_plan';
import { spots, type Plan } from '../src/model/plan';
import { on_earth } from '../src/model/site_map';
import { SHED } from './shed';

const plan: Plan = {
  name: 'P',
  frame: { map: 'shed' },
  items: [
    { type: 'map_point', x_m: 1, y_m: 2, yaw_deg: 10, speed_mps: 0.5 },
    { type: 'wait', seconds: 1 },
  ],
};
const at = { lat: 58, lon: 26, heading_deg: 0 };
const anchor = { ...at, accuracy_m: 0.1, heading_accuracy_deg: 1 };
const by: PlanMap = { map: { ...SHED, anchor }, at };

describe('the map that a mission is planned in', () => {
  test('is that of its name, also where it is not in use; of two the one in use', () => {
    const used = { ...SHED, id: 4, in_use: true };
    expect(map_of_plan(plan, [{ ...SHED, name: 'yard' }, SHED])).toBe(SHED);
    expect(map_of_plan(plan, [SHED, used])).toBe(used);
    expect(map_of_plan({ ...plan, frame: null }, [SHED])).toBeNull();
    expect(map_of_plan(plan, [])).toBeNull();
  });

  test('has its points where it lies', () => {
    const [spot] = spots(drawn_plan(plan, by));
    // x looks north, so y looks west.
    const { east_m, north_m } = offset_between(at, spot ?? at);
    expect([Math.round(east_m), Math.round(north_m)]).toEqual([-2, 1]);
    expect(spot?.index).toBe(0);
    expect(drawn_plan(plan, by).items[0]).toMatchObject({ type: 'waypoint', speed_mps: 0.5 });
    expect(drawn_plan(plan, null)).toBe(plan);
  });

  test('takes taps on its picture as its points, and those beside it as waypoints', () => {
    const tapped = (x_m: number, y_m: number, map: PlanMap | null) =>
      insert_there(2, on_earth(at, { x_m, y_m }), map)(plan).items[2];
    expect(tapped(9, 5, by)).toEqual({ type: 'map_point', x_m: 9, y_m: 5 });
    expect(tapped(11, 5, by)?.type).toBe('waypoint');
    expect(tapped(9, 5, null)?.type).toBe('waypoint');
    // One that lies nowhere has nothing beside it.
    expect(tapped(11, 5, { map: SHED, at })).toEqual({ type: 'map_point', x_m: 11, y_m: 5 });
    const turned = { ...SHED, anchor, origin: { x_m: 0, y_m: 0, yaw_deg: 90 } };
    expect(tapped(-5, 9, { map: turned, at })?.type).toBe('map_point');
    expect(tapped(5, 5, { map: turned, at })?.type).toBe('waypoint');
  });

  test('keeps what is dragged in it as its point, with what was set for it', () => {
    const dragged = move_there(0, on_earth(at, { x_m: 3, y_m: 4 }), by)(plan);
    expect(dragged.items[0]).toEqual({
      ...plan.items[0],
      x_m: 3,
      y_m: 4,
    });
  });

  test('moves all that are chosen by what one of them was dragged, waypoints among them', () => {
    const here = on_earth(at, { x_m: 5, y_m: 0 });
    const mixed: Plan = {
      ...plan,
      items: [
        { type: 'map_point', x_m: 1, y_m: 2, yaw_deg: 10 },
        { type: 'map_point', x_m: 4, y_m: 2 },
        { type: 'waypoint', ...here },
        { type: 'map_point', x_m: 8, y_m: 8 },
      ],
    };
    const picked = new Set([0, 1, 2]);
    for (const [index, to] of [
      [0, { x_m: 2, y_m: 4 }],
      [2, { x_m: 6, y_m: 2 }],
    ] as const) {
      const { items } = drag_there(picked, index, on_earth(at, to), by)(mixed);
      expect(items[0]).toEqual({ type: 'map_point', x_m: 2, y_m: 4, yaw_deg: 10 });
      expect(items[1]).toEqual({ type: 'map_point', x_m: 5, y_m: 4 });
      const { east_m, north_m } = offset_between(here, items[2] as typeof here);
      expect([Math.round(east_m * 1e3), Math.round(north_m * 1e3)]).toEqual([-2000, 1000]);
      expect(items[3]).toEqual({ type: 'map_point', x_m: 8, y_m: 8 });
    }
  });

  test('has a middle, however its picture is turned', () => {
    expect(middle_of_map(SHED)).toEqual({ x_m: 5, y_m: 3 });
    const turned = { ...SHED, origin: { x_m: 1, y_m: 1, yaw_deg: 90 } };
    expect(middle_of_map(turned)).toEqual({ x_m: -2, y_m: 6 });
  });
});
