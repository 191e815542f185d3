// The map that a mission's points count from: which ones there are to choose, and where a new point of
// it may lie.

import type { PlanAction } from './actions';
import type { OnMap, Plan } from './plan';
import { say } from './say';
import { middle_of_map } from './map_plan';
import type { MapPlace, SiteMap } from './site_map';

/** Where the robot stands in its map; nothing: it was not told. */
type Standing = Pick<MapPlace, 'map' | 'x_m' | 'y_m'> | undefined;

/** One counts from a map, or has points that must. */
export const counts_from_map = (plan: Plan): boolean =>
  Boolean(plan.frame) || plan.items.some(({ type }) => type === 'map_point');

/** Whether the robot is asked for its maps.
 * @param drawn they are listed, or one is drawn
 * @param planned what is edited; null: nothing is */
export const maps_wanted = (drawn: boolean, planned: Plan | null): boolean =>
  drawn || (planned !== null && counts_from_map(planned));

/** Names, each once: also the one that counts, should the robot have it no more. */
export const frames_to_choose = (
  plan: Plan,
  maps: readonly { readonly name: string }[],
  standing: Standing,
): readonly string[] => {
  const names = [...maps.map(({ name }) => name), standing?.map ?? '', plan.frame?.map ?? ''];
  return [...new Set(names)].filter((name) => name !== '');
};

/** Metres of one map are none of another. @param seen the map that counts, which is drawn; null: it is not
 * @return null: a point may be added */
export const why_not_map_point = (
  plan: Plan,
  standing: Standing,
  seen: SiteMap | null = null,
): string | null => {
  const frame = plan.frame?.map;
  const other = standing?.map ?? null;
  if (frame === undefined || frame === other || frame === seen?.name) return null;
  return other === null
    ? say('map_point_without_its_map', { frame })
    : say('map_point_by_another_map', { frame, other });
};

/** As places on the earth are: nobody knows it better. */
const centimetres = (value_m: number): number => Math.round(value_m * 100) / 100 + 0; // no -0

/** Where the robot is in the map; the middle of one that is seen while the robot is not in it. */
export const fresh_map_point = (standing: Standing, seen: SiteMap | null = null): OnMap => {
  const elsewhere =
    seen !== null && (standing?.map !== seen.name || (standing.x_m ?? null) === null);
  if (elsewhere) return { type: 'map_point', ...middle_of_map(seen) };
  return {
    type: 'map_point',
    x_m: centimetres(standing?.x_m ?? 0),
    y_m: centimetres(standing?.y_m ?? 0),
  };
};

/** The first point makes the mission count from the map that the robot uses. */
export const counted_where = (standing: Standing): PlanAction => {
  const map = standing?.map ?? null;
  return (plan) => (plan.frame || map === null ? plan : { ...plan, frame: { map } });
};
