// The tangent plane of the WGS84 ellipsoid at a place: metres to the east and to the north. A figure
// of 1 km that is turned or scaled in it keeps its shape within a tenth of a millimetre (the plane's
// error is d³/6R²), as the robot's own operations do.
// Source: Bowring 1976, Transformation from spatial to geographical coordinates.

import type { Offset } from './geo';
import { rounded } from './geo';
import type { LatLon } from './plan';

type Vector = readonly [x: number, y: number, z: number];

const A_M = 6378137;
const F = 1 / 298.257223563;
const E2 = F * (2 - F);
const B_M = A_M * (1 - F);
const SECOND_E2 = E2 / (1 - E2);
const RAD = Math.PI / 180;

const to_earth = ({ lat, lon }: LatLon): Vector => {
  const [sin, cos] = [Math.sin(lat * RAD), Math.cos(lat * RAD)];
  const radius = A_M / Math.sqrt(1 - E2 * sin * sin);
  return [
    radius * cos * Math.cos(lon * RAD),
    radius * cos * Math.sin(lon * RAD),
    radius * (1 - E2) * sin,
  ];
};

/** The place under a point near the ground. */
const from_earth = ([x, y, z]: Vector): LatLon => {
  const flat = Math.hypot(x, y);
  const theta = Math.atan2(z * A_M, flat * B_M);
  const lat = Math.atan2(
    z + SECOND_E2 * B_M * Math.sin(theta) ** 3,
    flat - E2 * A_M * Math.cos(theta) ** 3,
  );
  return { lat: lat / RAD, lon: Math.atan2(y, x) / RAD };
};

export interface Plane {
  to_plane(at: LatLon): Offset;
  /** Rounded as the robot keeps it. */
  from_plane(offset: Offset): LatLon;
}

/** @param origin not a pole */
export const plane_at = (origin: LatLon): Plane => {
  const [x0, y0, z0] = to_earth(origin);
  const [sin_lat, cos_lat] = [Math.sin(origin.lat * RAD), Math.cos(origin.lat * RAD)];
  const [sin_lon, cos_lon] = [Math.sin(origin.lon * RAD), Math.cos(origin.lon * RAD)];
  return {
    to_plane: (at) => {
      const [x, y, z] = to_earth(at);
      const [dx, dy, dz] = [x - x0, y - y0, z - z0];
      const outward = cos_lon * dx + sin_lon * dy;
      return {
        east_m: cos_lon * dy - sin_lon * dx,
        north_m: cos_lat * dz - sin_lat * outward,
      };
    },
    from_plane: ({ east_m, north_m }) => {
      // The ground falls away from the plane; straight down from it the height is lost again.
      const up_m = -(east_m * east_m + north_m * north_m) / (2 * A_M);
      const outward = cos_lat * up_m - sin_lat * north_m;
      return rounded(
        from_earth([
          x0 + cos_lon * outward - sin_lon * east_m,
          y0 + sin_lon * outward + cos_lon * east_m,
          z0 + sin_lat * up_m + cos_lat * north_m,
        ]),
      );
    },
  };
};
