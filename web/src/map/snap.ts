// Where a dragged point comes to lie exactly: on a point nearby, else on a line; else where the finger
// is.

import type { PlaneLine, PlanePoint } from './projection';

export interface Snapped {
  readonly to: PlanePoint;
  /** It lies on something. */
  readonly held: boolean;
}
export interface SnapLine extends PlaneLine {
  /** The last point is joined with the first. */
  readonly closed: boolean;
}

/** @param lines the first is the edited one
 * @param skip index of a point of it that is under the finger itself; -1: none
 * @param reach in units of the plane */
export const snapped = (
  lines: readonly SnapLine[],
  from: PlanePoint,
  reach: number,
  skip: number,
): Snapped => {
  const [x, y] = from;
  let to = from;
  let best = reach;
  lines.forEach(({ xs, ys }, n) => {
    const last = xs.length - 1;
    for (let k = 0; k <= last; k += 1) {
      // Of its own line the ends alone: a round is closed, and dense points do not stick together.
      if (n === 0 && (k === skip || (k > 0 && k < last))) continue;
      const off = Math.hypot((xs[k] ?? 0) - x, (ys[k] ?? 0) - y);
      if (off < best) [to, best] = [[xs[k] ?? 0, ys[k] ?? 0], off];
    }
  });
  if (best < reach) return { to, held: true };
  lines.forEach(({ xs, ys, closed }, n) => {
    // Its own legs move with it.
    if (n === 0) return;
    for (let k = closed ? 0 : 1; k < xs.length; k += 1) {
      const before = k === 0 ? xs.length - 1 : k - 1;
      const [ax, ay] = [xs[before] ?? 0, ys[before] ?? 0];
      const [dx, dy] = [(xs[k] ?? 0) - ax, (ys[k] ?? 0) - ay];
      const length2 = dx * dx + dy * dy;
      if (length2 === 0) continue;
      const share = Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / length2));
      const [fx, fy] = [ax + share * dx, ay + share * dy];
      const off = Math.hypot(fx - x, fy - y);
      if (off < best) [to, best] = [[fx, fy], off];
    }
  });
  return { to, held: best < reach };
};
