// The border between WGS84 and the map's plane (EPSG:3857). Nothing outside this room sees the
// plane, and nothing in it is a distance: at 60 degrees north a metre on the ground is two units.

import { fromLonLat, toLonLat } from 'ol/proj';

import { radian_m } from '../model/geo';
import type { LatLon } from '../model/plan';

export type PlanePoint = readonly [x: number, y: number];

const SPHERE_M = 6378137;

export const to_plane = (at: LatLon): PlanePoint => {
  const [x = 0, y = 0] = fromLonLat([at.lon, at.lat]);
  return [x, y];
};

export const from_plane = (point: readonly number[]): LatLon => {
  const [lon = 0, lat = 0] = toLonLat([point[0] ?? 0, point[1] ?? 0]);
  return { lat, lon };
};

/** Plane units for a metre on the ground, to the east and to the north. @param lat degrees */
export const units_per_m = (lat: number): { east: number; north: number } => {
  const ground = radian_m(lat);
  const cos_lat = Math.cos((lat * Math.PI) / 180);
  return { east: SPHERE_M / ground.east, north: SPHERE_M / cos_lat / ground.north };
};

/** A line in the plane: x and y of its points in columns. */
export interface PlaneLine {
  readonly xs: Float64Array;
  readonly ys: Float64Array;
}

export const to_plane_line = (points: readonly LatLon[]): PlaneLine => {
  const xs = new Float64Array(points.length);
  const ys = new Float64Array(points.length);
  points.forEach((point, k) => {
    const [x, y] = to_plane(point);
    xs[k] = x;
    ys[k] = y;
  });
  return { xs, ys };
};
