// Draws the mission that the robot has loaded, as a quieter line: what is done of it, how it is laid out,
// how far off it the robot may come, and which item is driven to.

import { class_of, PLAIN_CLASS, type TrailShades } from '../model/trail_shades';
import { around_px } from './boxes';
import { stroke_cased, trace_open, type Box, type Paint, type Pixels } from './canvas';
import type { DrawnDrive } from './drive_painter';
import { palette } from './palette';
import { disc, paint_arrows, paint_backwards, POINT_PX, type DrawnPlan } from './plan_painter';
import { to_plane, units_per_m, type PlaneLine, type PlanePoint } from './projection';

const WAY_PX = 2;
/** A narrower one hides behind the route. */
const CORRIDOR_FROM_PX = 16;

/** Number of the spot that is driven to. @param current_item from 1; 0: none */
const next_spot = ({ spots }: DrawnPlan, current_item: number): number => {
  const next = spots.findIndex(({ index }) => index + 1 >= current_item);
  return next < 0 ? spots.length : next;
};

/** Of what is ahead, by its class: the faster the wider, on both sides of the way in its middle. */
const LEFT_WIDTHS_PX: readonly number[] = [6, 7.5, 9, 10.5, 12, 9];

/** Pieces of a line, each [first, until) of its points, by the class of their speed. */
type Legs = readonly [number, number][][];

/** Each leg in the class of the speed that is set for it. */
const legs_by_set = (
  { band: { begin, end } }: DrawnPlan,
  done: number,
  speeds: readonly (number | null)[],
  shades: TrailShades,
): Legs => {
  const legs = Array.from({ length: PLAIN_CLASS + 1 }, (): [number, number][] => []);
  let [open, last] = [-1, null as [number, number] | null];
  for (let k = Math.max(0, done); k < begin.length; k += 1) {
    const at = class_of(shades, { speed_mps: speeds[k] ?? Number.NaN, off_m: Number.NaN });
    const from = k > 0 ? (end[k - 1] ?? 0) : 0;
    const to = (end[k] ?? 0) + 1;
    if (last && at === open) {
      last[1] = to;
      continue;
    }
    open = at;
    last = [from, to];
    legs[at]?.push(last);
  }
  return legs;
};

/** The way as it is laid, in the classes of the speed that is planned along it. */
const legs_by_pace = ({ pace }: DrawnDrive, current_item: number, shades: TrailShades): Legs => {
  const legs = Array.from({ length: PLAIN_CLASS + 1 }, (): [number, number][] => []);
  let [open, last] = [-1, null as [number, number] | null];
  const ahead = pace.findIndex(({ item }) => item >= current_item);
  const from = ahead < 0 ? pace.length : ahead;
  for (let k = from; k + 1 < pace.length; k += 1) {
    const speed_mps = ((pace[k]?.speed_mps ?? 0) + (pace[k + 1]?.speed_mps ?? 0)) / 2;
    const at = class_of(shades, { speed_mps, off_m: Number.NaN });
    if (last && at === open) {
      last[1] = k + 2;
      continue;
    }
    open = at;
    last = [k, k + 2];
    legs[at]?.push(last);
  }
  return legs;
};

/** What is ahead, in the colours of its speeds. */
const paint_shaded = (paint: Paint, line: PlaneLine, legs: Legs): void => {
  const colors = palette();
  const { context } = paint;
  context.lineJoin = 'round';
  context.lineCap = 'round';
  for (const casing of [true, false]) {
    legs.forEach((found, k) => {
      if (found.length === 0) return;
      context.beginPath();
      for (const [first, until] of found) trace_open(paint, line.xs, line.ys, first, until);
      const width_px = LEFT_WIDTHS_PX[k] ?? 9;
      const color = k === PLAIN_CLASS ? colors.route : colors.trail_classes[k];
      context.lineWidth = casing ? width_px + 3 : width_px;
      context.strokeStyle = casing ? colors.casing : (color ?? colors.route);
      context.stroke();
    });
  }
};

/** The loaded mission: what is done is faint. @param drive how it is to be driven; null: not shown */
export const paint_route = (
  paint: Paint,
  drawn: DrawnPlan,
  current_item: number,
  drive: DrawnDrive | null,
): void => {
  const colors = palette();
  const { context } = paint;
  const { line, end } = drawn.band;
  const done = next_spot(drawn, current_item);
  const left_from = done > 0 ? (end[done - 1] ?? 0) : 0;
  context.beginPath();
  if (done > 0) trace_open(paint, line.xs, line.ys, 0, left_from + 1);
  stroke_cased(context, colors.casing, colors.route_done, 9);
  if (drive?.shades && drive.pace.length > 1) {
    paint_shaded(paint, drive.pace_line, legs_by_pace(drive, current_item, drive.shades));
  } else if (drive?.shades) {
    paint_shaded(paint, line, legs_by_set(drawn, done, drive.speeds, drive.shades));
  } else {
    context.beginPath();
    trace_open(paint, line.xs, line.ys, left_from);
    stroke_cased(context, colors.casing, colors.route, 9);
  }
  paint_backwards(paint, drawn, colors.on_point);
  paint_arrows(paint, drawn.band, colors.on_point, 0.36);
};

/**
 * How far off its way the robot may come until the mission pauses: a soft band along what is left.
 * @param reach_m to both sides
 */
export const paint_corridor = (
  paint: Paint,
  drawn: DrawnPlan,
  current_item: number,
  reach_m: number,
): void => {
  const { context, resolution } = paint;
  const { line, end } = drawn.band;
  const done = next_spot(drawn, current_item);
  const wide_px = (2 * reach_m * units_per_m(drawn.spots[0]?.lat ?? 0).east) / resolution;
  if (done >= drawn.spots.length || wide_px < CORRIDOR_FROM_PX) return;
  context.beginPath();
  trace_open(paint, line.xs, line.ys, done > 0 ? (end[done - 1] ?? 0) : 0);
  context.lineJoin = 'round';
  context.lineCap = 'round';
  context.strokeStyle = palette().corridor;
  context.lineWidth = wide_px;
  context.stroke();
};

/** The item that is driven to. @return null: none */
export const target_of = (drawn: DrawnPlan, current_item: number): PlanePoint | null => {
  const target = current_item > 0 ? drawn.spots[next_spot(drawn, current_item)] : undefined;
  return target ? to_plane(target) : null;
};

const TARGET_PX = POINT_PX + 9;

export const target_box = (pixels: Pixels, [x, y]: PlanePoint): Box =>
  around_px(pixels.x_px(x), pixels.y_px(y), TARGET_PX + 6);

export const paint_target = (paint: Paint, [x, y]: PlanePoint): void => {
  const { casing, current } = palette();
  disc(paint.context, paint.x_px(x), paint.y_px(y), TARGET_PX);
  stroke_cased(paint.context, casing, current, 4.5);
};

/** How the loaded mission will be driven: corners rounded, dense points smoothed. */
export const paint_way = (paint: Paint, { xs, ys }: PlaneLine): void => {
  if (xs.length < 2) return;
  const { context } = paint;
  context.beginPath();
  trace_open(paint, xs, ys);
  context.strokeStyle = palette().way;
  context.lineWidth = WAY_PX;
  context.stroke();
};
