// Figures of the way between points: by how much it turns.

type Point = readonly [x: number, y: number];
type Leg = readonly [from: Point, to: Point];

/** Degrees from one leg to the next in (−180, 180], to the right positive: like a `turn` item. Of a
 * plane with y up. @return null: one of them has no length */
export const turn_at = (before: Leg, after: Leg): number | null => {
  const [ax, ay] = [before[1][0] - before[0][0], before[1][1] - before[0][1]];
  const [bx, by] = [after[1][0] - after[0][0], after[1][1] - after[0][1]];
  if (Math.hypot(ax, ay) === 0 || Math.hypot(bx, by) === 0) return null;
  const turn = (Math.atan2(ay * bx - ax * by, ax * bx + ay * by) * 180) / Math.PI;
  return turn === -180 ? 180 : turn;
};
