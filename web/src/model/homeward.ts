// Where “Come home” leads, before anything moves: the robot's own rule. RTL drives straight to the
// nearest of home and the rally points that can be reached without crossing the fence.

import { bearing_deg, distance_m, offset_between } from './geo';
import type { Fence, FenceArea } from './fence';
import type { LatLon } from './plan';

export interface Refuge {
  readonly name: string;
  readonly at: LatLon;
  readonly distance_m: number;
  readonly bearing_deg: number;
}

/** Nearer than this it has nothing to drive. */
export const AT_HOME_M = 0.3;

interface Xy {
  readonly x: number;
  readonly y: number;
}
const plane_of =
  (origin: LatLon) =>
  (at: LatLon): Xy => {
    const { east_m, north_m } = offset_between(origin, at);
    return { x: east_m, y: north_m };
  };

const side = (a: Xy, b: Xy, p: Xy): number => (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);

const cross = (a: Xy, b: Xy, c: Xy, d: Xy): boolean =>
  side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;

/** Whether the straight way from the origin to `to` meets the limit of an area. */
const crosses = (area: FenceArea, origin: LatLon, to: LatLon): boolean => {
  const plane = plane_of(origin);
  const from: Xy = { x: 0, y: 0 };
  const end = plane(to);
  if (area.circle) {
    const { radius_m } = area.circle;
    const middle = plane(area.circle);
    const reach = Math.hypot(end.x, end.y);
    const along = reach === 0 ? 0 : (middle.x * end.x + middle.y * end.y) / reach ** 2;
    const part = Math.min(Math.max(along, 0), 1);
    const least = Math.hypot(middle.x - part * end.x, middle.y - part * end.y);
    const most = Math.max(Math.hypot(middle.x, middle.y), Math.hypot(middle.x - end.x, middle.y - end.y)); // prettier-ignore
    return least < radius_m && most > radius_m;
  }
  const corners = (area.polygon ?? []).map(plane);
  return corners.some((corner, k) => {
    const next = corners[(k + 1) % corners.length];
    return next !== undefined && cross(from, end, corner, next);
  });
};

const free = (fence: Fence | null, from: LatLon, to: LatLon): boolean =>
  !(fence?.areas ?? []).some((area) => crosses(area, from, to));

/** @return null: there is no such place */
export const refuge = (home: LatLon | null, fence: Fence | null, from: LatLon): Refuge | null => {
  const places = [
    ...(home ? [{ name: 'Home', at: home }] : []),
    ...(fence?.rally ?? []).map((at, k) => ({ name: `Rally point ${k + 1}`, at })),
  ];
  let best: Refuge | null = null;
  for (const { name, at } of places) {
    const away_m = distance_m(from, at);
    if ((best && away_m >= best.distance_m) || !free(fence, from, at)) continue;
    best = { name, at, distance_m: away_m, bearing_deg: bearing_deg(from, at) };
  }
  return best;
};
