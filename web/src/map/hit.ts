// What lies under a finger: in the plane, over columns of numbers, so that 10,000 points are looked
// through with every move of a mouse.

import { leg, type Band } from './band';
import type { PlaneLine, PlanePoint } from './projection';

/** What lies there: a spot, or the way before spot `k` and the place on it. */
export interface Hit {
  readonly what: 'spot' | 'handle';
  readonly k: number;
  /** Where a new point comes. */
  readonly at: PlanePoint;
  /** On the "+" itself. */
  readonly middle: boolean;
  /** Other points are as near: nobody knows which is meant. */
  readonly crowded: boolean;
}

/** So many points under one finger. */
const CROWD = 4;

/** @param reach in units of the plane */
export const nearest_spot = (
  { xs, ys }: PlaneLine,
  count: number,
  from: PlanePoint,
  reach: number,
): { readonly k: number; readonly crowded: boolean } | null => {
  let best = -1;
  let best2 = reach * reach;
  let within = 0;
  for (let k = 0; k < count; k += 1) {
    const dx = (xs[k] ?? 0) - from[0];
    const dy = (ys[k] ?? 0) - from[1];
    const distance2 = dx * dx + dy * dy;
    if (distance2 > reach * reach) continue;
    within += 1;
    if (distance2 > best2) continue;
    best = k;
    best2 = distance2;
  }
  return best < 0 ? null : { k: best, crowded: within >= CROWD };
};

interface Reach {
  /** Beside the way, and around its "+"; units of the plane. */
  readonly line: number;
  readonly middle: number;
  /** Shorter ways have no "+", and are not taken elsewhere either. */
  readonly shortest: number;
}

/** Share of the way where it comes nearest, kept off its ends. */
const foot = (from: PlanePoint, a: PlanePoint, b: PlanePoint): number => {
  const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
  const along = (from[0] - a[0]) * dx + (from[1] - a[1]) * dy;
  return Math.min(1, Math.max(0, along / (dx * dx + dy * dy)));
};

/** Also where several ways lie together a "+" is clear; the way itself only where it is alone. */
export const nearest_leg = (band: Band, from: PlanePoint, reach: Reach): Hit | null => {
  let middle: Hit | null = null;
  let on_middle = reach.middle;
  let beside: Hit | null = null;
  let ways = 0;
  for (let k = 1; k < band.begin.length; k += 1) {
    const [a, b] = leg(band, k);
    if (Math.hypot(b[0] - a[0], b[1] - a[1]) < reach.shortest) continue;
    const centre: PlanePoint = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
    const off = Math.hypot(centre[0] - from[0], centre[1] - from[1]);
    if (off <= on_middle) {
      middle = { what: 'handle', k, at: centre, middle: true, crowded: false };
      on_middle = off;
    }
    const share = foot(from, a, b);
    const at: PlanePoint = [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])];
    if (Math.hypot(at[0] - from[0], at[1] - from[1]) > reach.line) continue;
    ways += 1;
    beside = { what: 'handle', k, at, middle: false, crowded: false };
  }
  return middle ?? (ways === 1 ? beside : null);
};

/** Spots inside of a box given by two of its corners. */
export const spots_in = (
  { xs, ys }: PlaneLine,
  count: number,
  [a, b]: readonly [PlanePoint, PlanePoint],
): number[] => {
  const [west, east] = [Math.min(a[0], b[0]), Math.max(a[0], b[0])];
  const [south, north] = [Math.min(a[1], b[1]), Math.max(a[1], b[1])];
  const found: number[] = [];
  for (let k = 0; k < count; k += 1) {
    const x = xs[k] ?? 0;
    const y = ys[k] ?? 0;
    if (x >= west && x <= east && y >= south && y <= north) found.push(k);
  }
  return found;
};
