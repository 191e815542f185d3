// A mission planned in a map of the plane, wherever the robot is: the map it counts from is drawn, and its
// points are tapped on it and dragged as waypoints are.

import {
  insert_item,
  insert_waypoint,
  move_waypoint,
  replace_item,
  type PlanAction,
} from './actions';
import { place_of, type Item, type LatLon, type Plan } from './plan';
import type { Placed } from './seen';
import type { Picked } from './selection';
import { drag_items } from './shapes';
import { in_map, lies_anywhere, on_earth, type MapPoint, type SiteMap } from './site_map';

/** The map that a plan counts from, and where it is drawn. */
export interface PlanMap {
  readonly map: SiteMap;
  readonly at: Placed;
}

/** Of two of that name the one in use. Null: it counts from none, or the robot does not have it. */
export const map_of_plan = (plan: Plan, maps: readonly SiteMap[]): SiteMap | null => {
  const named = maps.filter(({ name }) => name === plan.frame?.map);
  return named.find(({ in_use }) => in_use) ?? named[0] ?? null;
};

/** As it is drawn: the points of its map lie where the map does. Without the map they lie nowhere. */
export const drawn_plan = (plan: Plan, by: PlanMap | null): Plan => {
  if (!by || !plan.items.some(({ type }) => type === 'map_point')) return plan;
  const items = plan.items.map((item): Item => {
    if (item.type !== 'map_point') return item;
    const { x_m, y_m, yaw_deg, type, ...driven } = item;
    void [yaw_deg, type];
    return { type: 'waypoint', ...driven, ...on_earth(by.at, { x_m, y_m }) };
  });
  return { ...plan, items };
};

const within = (
  { origin, width, height, resolution_m }: SiteMap,
  { x_m, y_m }: MapPoint,
): boolean => {
  const turn = (origin.yaw_deg * Math.PI) / 180;
  const [east, north] = [x_m - origin.x_m, y_m - origin.y_m];
  const u = east * Math.cos(turn) + north * Math.sin(turn);
  const v = north * Math.cos(turn) - east * Math.sin(turn);
  return u >= 0 && v >= 0 && u <= width * resolution_m && v <= height * resolution_m;
};

/** A place on the map's picture; of a map that lies nowhere on the earth every place is one of it. */
const counts_there = ({ map, at }: PlanMap, place: LatLon): boolean =>
  lies_anywhere(map) || within(map, in_map(at, place));

/** @param index before which it comes; what lies beside the map is a waypoint */
export const insert_there = (index: number, place: LatLon, by: PlanMap | null): PlanAction =>
  by && counts_there(by, place)
    ? insert_item(index, { type: 'map_point', ...in_map(by.at, place) })
    : insert_waypoint(index, place);

/** What is dragged stays what it is. */
export const move_there =
  (index: number, place: LatLon, by: PlanMap | null): PlanAction =>
  (plan) => {
    const item = plan.items[index];
    return by && item?.type === 'map_point'
      ? replace_item(index, { ...item, ...in_map(by.at, place) })(plan)
      : move_waypoint(index, place)(plan);
  };

/** All that are chosen, by what one of them was dragged: points of the map stay points of it. */
export const drag_there =
  (picked: Picked, index: number, to: LatLon, by: PlanMap | null): PlanAction =>
  (plan) => {
    const moved = drag_items(picked, index, to)(drawn_plan(plan, by));
    const items = plan.items.map((item, i): Item => {
      const now = moved.items[i] ?? item;
      if (item.type !== 'map_point') return now;
      const at = place_of(now);
      return by && at && picked.has(i) ? { ...item, ...in_map(by.at, at) } : item;
    });
    return { ...plan, items };
  };

/** The middle of its picture: where a point of it begins that nobody has shown. */
export const middle_of_map = ({ origin, width, height, resolution_m }: SiteMap): MapPoint => {
  const turn = (origin.yaw_deg * Math.PI) / 180;
  const [u, v] = [(width * resolution_m) / 2, (height * resolution_m) / 2];
  const rounded = (metres: number): number => Math.round(metres * 1000) / 1000;
  return {
    x_m: rounded(origin.x_m + u * Math.cos(turn) - v * Math.sin(turn)),
    y_m: rounded(origin.y_m + u * Math.sin(turn) + v * Math.cos(turn)),
  };
};
