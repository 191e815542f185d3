// Above the mission that is edited: the chosen points, the box that chooses more, what lies beside it
// to compare, and where a dragged point was caught.

import type { BesideTone, LineOnMap, PointMark } from '../model/on_map';
import { trace, stroke_cased, type Paint } from './canvas';
import { palette } from './palette';
import { to_plane_line, type PlaneLine, type PlanePoint } from './projection';

export interface DrawnBeside {
  readonly line: PlaneLine;
  readonly tone: BesideTone;
  readonly points: PointMark | null;
}

export const prepare_beside = ({ places, tone, points }: LineOnMap): DrawnBeside => ({
  line: to_plane_line(places),
  tone,
  points: points ?? null,
});

const FULL = 2 * Math.PI;
/** With more of them in sight rings would be a blot. */
const RINGS_MOST = 400;

const ring = (context: CanvasRenderingContext2D, x: number, y: number, r: number): void => {
  context.moveTo(x + r, y);
  context.arc(x, y, r, 0, FULL);
};

/** A ring around each of them, as they lie now. @param ks of the spots */
export const paint_picked = (paint: Paint, { xs, ys }: PlaneLine, ks: readonly number[]): void => {
  const { context, width_px, height_px } = paint;
  const colors = palette();
  const seen = ks.flatMap((k): PlanePoint[] => {
    const [x, y] = [paint.x_px(xs[k] ?? 0), paint.y_px(ys[k] ?? 0)];
    return x > -20 && y > -20 && x < width_px + 20 && y < height_px + 20 ? [[x, y]] : [];
  });
  const small = seen.length > RINGS_MOST;
  context.beginPath();
  for (const [x, y] of seen) ring(context, x, y, small ? 3 : 19);
  if (small) {
    context.fillStyle = colors.selected;
    context.fill();
  } else stroke_cased(context, colors.casing, colors.selected, 4);
};

export const paint_box = (paint: Paint, [a, b]: readonly [PlanePoint, PlanePoint]): void => {
  const { context } = paint;
  const colors = palette();
  const [x, y] = [paint.x_px(a[0]), paint.y_px(a[1])];
  const [width, height] = [paint.x_px(b[0]) - x, paint.y_px(b[1]) - y];
  context.fillStyle = colors.wedge;
  context.fillRect(x, y, width, height);
  context.beginPath();
  context.rect(x, y, width, height);
  stroke_cased(context, colors.casing, colors.selected, 2);
};

/** With the finger's own size: told apart by shape, too. */
const RING_PX = 22;
const AROUND_PX = 29;
const CROSS_PX = 11;

const mark_points = (paint: Paint, { xs, ys }: PlaneLine, points: PointMark): void => {
  const { context } = paint;
  for (let k = 0; k < xs.length; k += 1) {
    const [x, y] = [paint.x_px(xs[k] ?? 0), paint.y_px(ys[k] ?? 0)];
    if (points === 'cross') {
      context.moveTo(x - CROSS_PX, y - CROSS_PX);
      context.lineTo(x + CROSS_PX, y + CROSS_PX);
      context.moveTo(x - CROSS_PX, y + CROSS_PX);
      context.lineTo(x + CROSS_PX, y - CROSS_PX);
    } else ring(context, x, y, points === 'ring' ? RING_PX : AROUND_PX);
  }
};

/** Dashed: it is no way that is driven. */
export const paint_beside = (paint: Paint, beside: readonly DrawnBeside[]): void => {
  const { context } = paint;
  const colors = palette();
  const tones: Record<BesideTone, string> = {
    taken: colors.route,
    changed: colors.selected,
    left_out: colors.refused,
    looked: colors.plan,
    drawn: colors.stay_in,
    before: colors.grid_label,
    other: colors.home,
    theirs: colors.run_a,
    added: colors.route,
    gone: colors.refused,
  };
  for (const { line, tone, points } of beside) {
    if (line.xs.length === 0) continue;
    context.beginPath();
    if (points) {
      mark_points(paint, line, points);
      stroke_cased(context, colors.casing, tones[tone], 4);
      continue;
    }
    trace(paint, line.xs, line.ys);
    context.setLineDash([]);
    context.lineJoin = 'round';
    context.lineWidth = 6;
    context.strokeStyle = colors.casing;
    context.stroke();
    context.setLineDash([10, 7]);
    context.lineWidth = 3.5;
    context.strokeStyle = tones[tone];
    context.stroke();
    context.setLineDash([]);
  }
};

/** Where a dragged point lies on something. */
export const paint_caught = (paint: Paint, [x, y]: PlanePoint): void => {
  const { context } = paint;
  const colors = palette();
  const [cx, cy] = [paint.x_px(x), paint.y_px(y)];
  context.beginPath();
  context.moveTo(cx - 26, cy);
  context.lineTo(cx + 26, cy);
  context.moveTo(cx, cy - 26);
  context.lineTo(cx, cy + 26);
  ring(context, cx, cy, 22);
  stroke_cased(context, colors.casing, colors.selected, 2);
};
