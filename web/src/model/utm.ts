// UTM on the WGS84 ellipsoid: what maps on paper and surveyors' lists say. A transverse Mercator by
// Krüger's series to the fourth order in n: a tenth of a millimetre within a zone.
// Source: Karney 2011, Transverse Mercator with an accuracy of a few nanometers, (7) to (12), (35), (36).

import type { LatLon } from './plan';

export interface Utm {
  /** 1 to 60. */
  readonly zone: number;
  /** C to X without I and O: from south to north; N and up is the northern half. */
  readonly band: string;
  readonly east_m: number;
  readonly north_m: number;
}

const RAD = Math.PI / 180;
const F = 1 / 298.257223563;
const E = Math.sqrt(F * (2 - F));
const n = F / (2 - F);
const K0 = 0.9996;
/** Metres of a radian on the middle meridian. */
const A_M = ((K0 * 6378137) / (1 + n)) * (1 + n ** 2 / 4 + n ** 4 / 64);
const ALPHA = [
  n / 2 - (2 / 3) * n ** 2 + (5 / 16) * n ** 3 + (41 / 180) * n ** 4,
  (13 / 48) * n ** 2 - (3 / 5) * n ** 3 + (557 / 1440) * n ** 4,
  (61 / 240) * n ** 3 - (103 / 140) * n ** 4,
  (49561 / 161280) * n ** 4,
];
const BETA = [
  n / 2 - (2 / 3) * n ** 2 + (37 / 96) * n ** 3 - (1 / 360) * n ** 4,
  n ** 2 / 48 + n ** 3 / 15 - (437 / 1440) * n ** 4,
  (17 / 480) * n ** 3 - (37 / 840) * n ** 4,
  (4397 / 161280) * n ** 4,
];
const FALSE_EAST_M = 500_000;
const FALSE_NORTH_M = 10_000_000;
const BANDS = 'CDEFGHJKLMNPQRSTUVWX';
const LEAST_LAT = -80;
const MOST_LAT = 84;

const middle_lon = (zone: number): number => 6 * zone - 183;

/** South-west Norway and Svalbard have zones of their own widths. */
const zone_of = (lat: number, lon: number): number => {
  if (lat >= 56 && lat < 64 && lon >= 3 && lon < 12) return 32;
  if (lat >= 72 && lon >= 0 && lon < 42) return lon < 9 ? 31 : lon < 21 ? 33 : lon < 33 ? 35 : 37;
  return Math.floor((lon + 180) / 6) + 1;
};

/** Tangent of the conformal latitude. @param tau tangent of the latitude */
const conformal = (tau: number): number => {
  const root = Math.hypot(1, tau);
  const sigma = Math.sinh(E * Math.atanh((E * tau) / root));
  return tau * Math.hypot(1, sigma) - sigma * root;
};

/** The other way, by Newton's steps. */
const geographic = (tau_c: number): number => {
  let tau = tau_c / (1 - E * E);
  for (let k = 0; k < 5; k += 1) {
    const now = conformal(tau);
    const slope =
      ((1 - E * E) * Math.hypot(1, now) * Math.hypot(1, tau)) / (1 + (1 - E * E) * tau * tau);
    tau += (tau_c - now) / slope;
  }
  return tau;
};

/** @return null: beyond 84° north or 80° south there is none */
export const utm_of = ({ lat, lon }: LatLon): Utm | null => {
  if (!(lat >= LEAST_LAT && lat <= MOST_LAT) || !Number.isFinite(lon)) return null;
  const east_of_greenwich = ((((lon + 180) % 360) + 360) % 360) - 180;
  const zone = zone_of(lat, east_of_greenwich);
  const lambda = (east_of_greenwich - middle_lon(zone)) * RAD;
  const tau = conformal(Math.tan(lat * RAD));
  const xi = Math.atan2(tau, Math.cos(lambda));
  const eta = Math.asinh(Math.sin(lambda) / Math.hypot(tau, Math.cos(lambda)));
  let [north, east] = [xi, eta];
  ALPHA.forEach((a, k) => {
    const j = 2 * (k + 1);
    north += a * Math.sin(j * xi) * Math.cosh(j * eta);
    east += a * Math.cos(j * xi) * Math.sinh(j * eta);
  });
  return {
    zone,
    band: BANDS[Math.min(19, Math.floor((lat - LEAST_LAT) / 8))] ?? '',
    east_m: FALSE_EAST_M + A_M * east,
    north_m: A_M * north + (lat < 0 ? FALSE_NORTH_M : 0),
  };
};

/** @return null: no such zone or band, or a place that is not in it */
export const place_of_utm = ({ zone, band, east_m, north_m }: Utm): LatLon | null => {
  const row = BANDS.indexOf(band.toUpperCase());
  if (!Number.isInteger(zone) || zone < 1 || zone > 60 || row < 0 || band.length !== 1) return null;
  if (!(east_m >= 100_000 && east_m < 1_000_000) || !(north_m >= 0 && north_m <= FALSE_NORTH_M)) {
    return null;
  }
  const xi = (north_m - (row < 10 ? FALSE_NORTH_M : 0)) / A_M;
  const eta = (east_m - FALSE_EAST_M) / A_M;
  let [xi_c, eta_c] = [xi, eta];
  BETA.forEach((b, k) => {
    const j = 2 * (k + 1);
    xi_c -= b * Math.sin(j * xi) * Math.cosh(j * eta);
    eta_c -= b * Math.cos(j * xi) * Math.sinh(j * eta);
  });
  const tau = geographic(Math.sin(xi_c) / Math.hypot(Math.sinh(eta_c), Math.cos(xi_c)));
  const lat = Math.atan(tau) / RAD;
  const lon = middle_lon(zone) + Math.atan2(Math.sinh(eta_c), Math.cos(xi_c)) / RAD;
  // A band tells the half of the earth; a row farther off it is a slip of the pen.
  if (Math.abs(lat - (LEAST_LAT + 8 * row + 4)) > 12) return null;
  return { lat, lon: lon >= 180 ? lon - 360 : lon < -180 ? lon + 360 : lon };
};
