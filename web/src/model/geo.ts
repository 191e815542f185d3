// Distances on the WGS84 ellipsoid for display, good to a centimetre over a few kilometres: the
// meridian (M) and prime-vertical (N) radii at the middle latitude. What the robot drives is
// computed by the server; these figures only label the map.

import type { LatLon } from './plan';

const A_M = 6378137;
const E2 = 6.69437999014e-3;
const RAD = Math.PI / 180;

export interface Offset {
  readonly east_m: number;
  readonly north_m: number;
}

/** Metres for one radian of latitude and of longitude at a latitude. @param lat degrees */
export const radian_m = (lat: number): { north: number; east: number } => {
  const sin_lat = Math.sin(lat * RAD);
  const w2 = 1 - E2 * sin_lat * sin_lat;
  const prime_vertical = A_M / Math.sqrt(w2);
  const meridian = (prime_vertical * (1 - E2)) / w2;
  return { north: meridian, east: prime_vertical * Math.cos(lat * RAD) };
};

/** Longitude difference the short way round, degrees in [-180, 180). */
const lon_difference = (from: number, to: number): number => ((to - from + 540) % 360) - 180;

/** Where `to` lies from `from`. */
export const offset_between = (from: LatLon, to: LatLon): Offset => {
  const scale = radian_m((from.lat + to.lat) / 2);
  return {
    east_m: lon_difference(from.lon, to.lon) * RAD * scale.east,
    north_m: (to.lat - from.lat) * RAD * scale.north,
  };
};

/** The point that lies `offset` from `from`. Not for points beside a pole. */
export const offset_from = (from: LatLon, offset: Offset): LatLon => {
  const rough_lat = from.lat + offset.north_m / (radian_m(from.lat).north * RAD);
  const scale = radian_m((from.lat + rough_lat) / 2);
  return {
    lat: from.lat + offset.north_m / (scale.north * RAD),
    lon: from.lon + offset.east_m / (scale.east * RAD),
  };
};

/** Farther apart than a degree, along a sphere: to half a percent. */
const FAR_DEG = 1;
const SPHERE_M = 6371008.8;

export const distance_m = (from: LatLon, to: LatLon): number => {
  const turn = lon_difference(from.lon, to.lon);
  if (Math.abs(turn) <= FAR_DEG && Math.abs(to.lat - from.lat) <= FAR_DEG) {
    const { east_m, north_m } = offset_between(from, to);
    return Math.hypot(east_m, north_m);
  }
  const half =
    Math.sin(((to.lat - from.lat) * RAD) / 2) ** 2 +
    Math.cos(from.lat * RAD) * Math.cos(to.lat * RAD) * Math.sin((turn * RAD) / 2) ** 2;
  return 2 * SPHERE_M * Math.asin(Math.min(1, Math.sqrt(half)));
};

/** Compass bearing, degrees in [0, 360). */
export const bearing_deg = (from: LatLon, to: LatLon): number => {
  const { east_m, north_m } = offset_between(from, to);
  return (Math.atan2(east_m, north_m) / RAD + 360) % 360;
};

/** Sum of the legs between consecutive points, metres. */
export const length_m = (points: readonly LatLon[]): number => {
  let sum = 0;
  let last: LatLon | undefined;
  for (const point of points) {
    if (last) sum += distance_m(last, point);
    last = point;
  }
  return sum;
};

export const midpoint = (a: LatLon, b: LatLon): LatLon => ({
  lat: (a.lat + b.lat) / 2,
  lon: a.lon + lon_difference(a.lon, b.lon) / 2,
});

/** The 9 decimals that survive a round trip through the server (0.1 mm). */
export const rounded = (at: LatLon): LatLon => ({
  lat: Math.round(at.lat * 1e9) / 1e9,
  lon: Math.round(lon_difference(0, at.lon) * 1e9) / 1e9,
});

/** The largest of 1, 2, 5 × 10ⁿ not above `value`. @param value > 0 */
export const round_step_below = (value: number): number => {
  const power = 10 ** Math.floor(Math.log10(value) + 1e-12);
  const lead = value / power;
  return (lead >= 5 - 1e-9 ? 5 : lead >= 2 - 1e-9 ? 2 : 1) * power;
};

/** The smallest of 1, 2, 5 × 10ⁿ not below `value`. @param value > 0 */
export const round_step_above = (value: number): number => {
  const power = 10 ** Math.floor(Math.log10(value) + 1e-12);
  const lead = value / power;
  return (lead <= 1 + 1e-9 ? 1 : lead <= 2 + 1e-9 ? 2 : lead <= 5 + 1e-9 ? 5 : 10) * power;
};
