import { expect, test } from 'vitest';

import { map_to_come } from '../src/model/map_to_come';
import type { MapCalls } from '../src/model/ports';

/** A map that only writes down what it is told. */
const listening = (): { map: MapCalls; heard: unknown[][] } => {
  const heard: unknown[][] = [];
  const map = {
    set_cover: (...px: number[]) => heard.push(['set_cover', ...px]),
    set_follow: (follow: boolean) => heard.push(['set_follow', follow]),
    fit: (points: unknown) => heard.push(['fit', points]),
    zoom_level: () => 17,
    view_bounds: () => ({ west: 1, south: 2, east: 3, north: 4 }),
  } as unknown as MapCalls;
  return { map, heard };
};

const FIELD = [{ lat: 58.1, lon: 26.5 }];

test('a map that comes late hears the last of each kind, in the order in which they were said', () => {
  const early = map_to_come();
  early.map.set_cover(1, 0, 0, 0);
  early.map.set_follow(true);
  early.map.fit(FIELD);
  early.map.set_cover(2, 0, 0, 0);

  const { map, heard } = listening();
  early.come(map);

  expect(heard).toEqual([
    ['set_cover', 2, 0, 0, 0], // first: what is fitted is fitted beside the panels
    ['set_follow', true],
    ['fit', FIELD],
  ]);
});

test('once it is there it is told itself, each time', () => {
  const early = map_to_come();
  const { map, heard } = listening();
  early.come(map);
  early.map.set_follow(true);
  early.map.set_follow(false);
  expect(heard).toEqual([
    ['set_follow', true],
    ['set_follow', false],
  ]);
});

test('what is asked of a map that is not there shows nothing, and is not asked later', () => {
  const early = map_to_come();
  expect(early.map.view_bounds()).toBeNull();
  expect(early.map.zoom_level()).toBe(0);

  const { map, heard } = listening();
  early.come(map);
  expect(heard).toEqual([]);
  expect(early.map.zoom_level()).toBe(17);
  expect(early.map.view_bounds()).toEqual({ west: 1, south: 2, east: 3, north: 4 });
});
