// Where “Come home” leads, before anything moves, as the robot itself tells it; and why it would do
// nothing.

import { robot_says } from './robot_words';
import type { LatLon } from './plan';
import { say, told } from './say';

export interface WayHome {
  readonly target: LatLon | null;
  readonly target_is: 'home' | 'rally_point' | 'begin_of_way' | null;
  /** Along the line. */
  readonly distance_m: number | null;
  /** From the robot to the target. */
  readonly line: readonly LatLon[];
  readonly possible: boolean;
  /** Why not possible. */
  readonly reason: string;
}

const words: Record<NonNullable<WayHome['target_is']>, string> = told({
  home: 'home',
  rally_point: 'rally_point',
  begin_of_way: 'where_its_way_began',
});
/** Nearer than this it has nothing to drive. */
export const AT_HOME_M = 0.3;

export const target_words = ({ target_is }: WayHome): string =>
  target_is === null ? say('come_home') : words[target_is];

/** @return null: it would drive */
export const why_not_home = (way: WayHome): string | null => {
  if (!way.possible) return robot_says(way.reason);
  return way.distance_m !== null && way.distance_m < AT_HOME_M
    ? say('it_stands_there_already_way', { way: target_words(way).toLowerCase() })
    : null;
};
