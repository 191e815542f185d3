import { describe, expect, test } from 'vitest';

import { append_item } from '../src/model/actions';
import {
  counted_where,
  counts_from_map,
  frames_to_choose,
  fresh_map_point,
  maps_wanted,
  why_not_map_point,
} from '../src/model/map_frame';
import { item_title, type Item, type Plan } from '../src/model/plan';
import { SHED } from './shed';

const point: Item = { type: 'map_point', x_m: 1, y_m: 2 };
const wait: Item = { type: 'wait', seconds: 1 };
const bare: Plan = { name: 'P', items: [wait] };
const pointed: Plan = { name: 'P', items: [wait, point] };
const framed: Plan = { ...bare, frame: { map: 'shed' } };
const in_yard = { map: 'yard', x_m: 3.5, y_m: -1.25 };

describe('the maps to count from', () => {
  test('are asked for while a plan counts from one, wherever the robot is', () => {
    expect([bare, pointed, framed].map(counts_from_map)).toEqual([false, true, true]);
    expect([bare, pointed, framed].map((plan) => maps_wanted(false, plan))).toEqual([
      ...[false, true, true],
    ]);
    expect(maps_wanted(true, bare)).toBe(true);
    expect(maps_wanted(false, null)).toBe(false);
  });

  test('are those of the robot, the one it uses, and the one that counts, each once', () => {
    const maps = [{ name: 'yard' }, { name: 'hall' }, { name: 'yard' }];
    expect(frames_to_choose(framed, maps, in_yard)).toEqual(['yard', 'hall', 'shed']);
    expect(frames_to_choose(pointed, [], in_yard)).toEqual(['yard']);
    expect(frames_to_choose({ ...pointed, frame: null }, [], { map: null })).toEqual([]);
  });
});

describe('a new point of the map', () => {
  test('is refused where the robot uses another map than the mission counts from, or none', () => {
    const another = why_not_map_point(framed, in_yard);
    expect(another).toMatch(/“shed”.*“yard”/);
    const none = [{ map: null }, undefined].map((at) => why_not_map_point(framed, at));
    expect(none).toEqual(Array(2).fill(expect.stringMatching(/“shed”.*does not use/)));
  });

  test('is offered in the map that counts, or while none does', () => {
    expect(why_not_map_point(framed, { ...in_yard, map: 'shed' })).toBeNull();
    expect(why_not_map_point(pointed, in_yard)).toBeNull();
    expect(why_not_map_point({ ...pointed, frame: null }, undefined)).toBeNull();
  });

  test('is offered in a map of the list that is drawn, and begins in its middle', () => {
    const seen = { ...SHED, name: 'shed' };
    expect(why_not_map_point(framed, in_yard, seen)).toBeNull();
    expect(fresh_map_point(in_yard, seen)).toEqual({ type: 'map_point', x_m: 5, y_m: 3 });
    expect(fresh_map_point({ ...in_yard, map: 'shed' }, seen)).toMatchObject({ x_m: 3.5 });
    expect(fresh_map_point({ map: 'shed', x_m: null }, seen)).toMatchObject({ x_m: 5 });
  });

  test('lies where the robot is, and the first one says from which map it counts', () => {
    const added = append_item(fresh_map_point(in_yard))(counted_where(in_yard)(bare));
    expect(added.frame).toEqual({ map: 'yard' });
    expect(added.items).toEqual([wait, { type: 'map_point', x_m: 3.5, y_m: -1.25 }]);
    expect(counted_where(in_yard)(framed)).toBe(framed);
    expect(counted_where({ map: null })(bare)).toBe(bare);
    expect(fresh_map_point({ map: 'yard', x_m: null })).toEqual({ ...point, x_m: 0, y_m: 0 });
    const fine = fresh_map_point({ map: 'yard', x_m: 2.498370912, y_m: -0.001 });
    expect(fine).toEqual({ ...point, x_m: 2.5, y_m: 0 });
    expect(item_title({ ...point, x_m: 2.498370912, y_m: 3 })).toBe(
      'In the map: x 2.50 m, y 3.00 m',
    );
  });
});
