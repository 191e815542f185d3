// Draws the robot, how sure it is of place and heading, the driven trail and home.

import type { LatLon } from '../model/plan';
import type { RobotOnMap } from '../model/ports';
import type { Trail } from '../model/trail';
import { stroke_cased, trace, type Paint } from './canvas';
import type { Palette } from './palette';
import { to_plane, units_per_m } from './projection';

const DOTS_APART_PX = 7;

/** A trail in the plane, kept in step with the model's ring: a line in pieces, or dots. */
export class TrailLine {
  readonly #xs: number[] = [];
  readonly #ys: number[] = [];
  readonly #begins: boolean[] = [];
  #seen = 0;

  follow(trail: Trail): void {
    const fresh = Math.min(trail.added - this.#seen, trail.length);
    this.#seen = trail.added;
    for (let k = trail.length - fresh; k < trail.length; k += 1) {
      const at = trail.at(k);
      if (!at) continue;
      const [x, y] = to_plane(at);
      this.#xs.push(x);
      this.#ys.push(y);
      this.#begins.push(trail.begins(k));
    }
    const surplus = this.#xs.length - trail.length;
    if (surplus > 0) {
      this.#xs.splice(0, surplus);
      this.#ys.splice(0, surplus);
      this.#begins.splice(0, surplus);
    }
  }

  /** A dot for every point that is not too near to the dot before. */
  paint_dots(paint: Paint, color: string): void {
    const { context } = paint;
    let [last_x, last_y] = [Number.NaN, Number.NaN];
    context.beginPath();
    for (let k = 0; k < this.#xs.length; k += 1) {
      const x = paint.x_px(this.#xs[k] ?? 0);
      const y = paint.y_px(this.#ys[k] ?? 0);
      if (Math.hypot(x - last_x, y - last_y) < DOTS_APART_PX) continue;
      context.rect(x - 2.5, y - 2.5, 5, 5);
      [last_x, last_y] = [x, y];
    }
    context.fillStyle = color;
    context.fill();
  }

  paint_line(paint: Paint, colors: Palette): void {
    const count = this.#xs.length;
    if (count < 2) return;
    paint.context.beginPath();
    let first = 0;
    for (let k = 1; k <= count; k += 1) {
      if (k < count && !this.#begins[k]) continue;
      trace(paint, this.#xs, this.#ys, first, k);
      first = k;
    }
    stroke_cased(paint.context, colors.casing, colors.trail, 3);
  }
}

const ARROW_PX = 19;

/** An arrow head around the origin that points up, to be turned by the heading. */
const arrow_path = (context: CanvasRenderingContext2D, size: number): void => {
  context.beginPath();
  context.moveTo(0, -size);
  context.lineTo(size * 0.74, size * 0.78);
  context.lineTo(0, size * 0.4);
  context.lineTo(-size * 0.74, size * 0.78);
  context.closePath();
};

export interface Size {
  readonly length_m: number;
  readonly width_m: number;
}

/** How far off the robot may be. Under everything else, which it must not tint: it can be wide. */
export const paint_accuracy = (paint: Paint, robot: RobotOnMap, colors: Palette): void => {
  const { context, resolution } = paint;
  const [x, y] = to_plane(robot.at);
  const metre_px = units_per_m(robot.at.lat).east / resolution;
  const round_m = robot.accuracy_m ?? 0;
  const { major_m, minor_m, orientation_deg } = robot.ellipse ?? {
    major_m: round_m,
    minor_m: round_m,
    orientation_deg: 0,
  };
  if (major_m * metre_px <= 4) return;
  context.beginPath();
  // On the canvas angles go clockwise from the right.
  const turn = ((orientation_deg - 90) * Math.PI) / 180;
  const [long_px, wide_px] = [major_m * metre_px, Math.max(1, minor_m * metre_px)];
  context.ellipse(paint.x_px(x), paint.y_px(y), long_px, wide_px, turn, 0, 2 * Math.PI);
  context.fillStyle = colors.ring;
  context.fill();
  context.strokeStyle = colors.plan;
  context.lineWidth = 1;
  context.stroke();
};

const WEDGE_PX = 64;
/** A narrower wedge hides behind the arrow. */
const WEDGE_FROM_DEG = 3;

/** How far off the heading may be, to both sides of it, two sigma. The origin is the robot. */
const paint_wedge = (context: CanvasRenderingContext2D, sigma_deg: number, color: string): void => {
  if (sigma_deg < WEDGE_FROM_DEG) return;
  const half = (Math.min(2 * sigma_deg, 180) * Math.PI) / 180;
  context.beginPath();
  context.moveTo(0, 0);
  context.arc(0, 0, WEDGE_PX, -Math.PI / 2 - half, -Math.PI / 2 + half);
  context.closePath();
  context.fillStyle = color;
  context.fill();
};

/** Under the robot: how long ago that was. */
const paint_age = (context: CanvasRenderingContext2D, words: string, colors: Palette): void => {
  context.font = '700 13px system-ui, sans-serif';
  context.textAlign = 'center';
  context.textBaseline = 'top';
  context.lineJoin = 'round';
  context.strokeStyle = colors.casing;
  context.lineWidth = 4;
  context.strokeText(words, 0, 26);
  context.fillStyle = colors.refused;
  context.fillText(words, 0, 26);
};

export const paint_robot = (paint: Paint, robot: RobotOnMap, size: Size, colors: Palette): void => {
  const { context, resolution } = paint;
  const [x, y] = to_plane(robot.at);
  const metre_px = units_per_m(robot.at.lat).east / resolution;
  const color = robot.stale ? colors.robot_stale : colors.robot;
  context.translate(paint.x_px(x), paint.y_px(y));
  if (robot.old !== null) paint_age(context, robot.old, colors);

  if (robot.heading_deg === null) {
    context.beginPath();
    context.arc(0, 0, 11, 0, 2 * Math.PI);
    stroke_cased(context, colors.casing, color, 5);
    return;
  }
  context.rotate((robot.heading_deg * Math.PI) / 180);
  if (!robot.stale) paint_wedge(context, robot.heading_accuracy_deg ?? 0, colors.wedge);
  const [long_px, wide_px] = [size.length_m * metre_px, size.width_m * metre_px];
  if (long_px > ARROW_PX) {
    context.beginPath();
    context.rect(-wide_px / 2, -long_px / 2, wide_px, long_px);
    context.strokeStyle = color;
    context.lineWidth = 1.5;
    context.stroke();
  }
  arrow_path(context, ARROW_PX);
  context.lineJoin = 'round';
  context.strokeStyle = colors.casing;
  context.lineWidth = 6;
  context.stroke();
  context.fillStyle = color;
  context.fill();
};

/** A house. */
export const paint_home = (paint: Paint, home: LatLon, colors: Palette): void => {
  const { context } = paint;
  const [x, y] = to_plane(home);
  context.translate(paint.x_px(x), paint.y_px(y));
  context.beginPath();
  context.moveTo(0, -11);
  context.lineTo(11, -1);
  context.lineTo(8, -1);
  context.lineTo(8, 10);
  context.lineTo(-8, 10);
  context.lineTo(-8, -1);
  context.lineTo(-11, -1);
  context.closePath();
  context.strokeStyle = colors.casing;
  context.lineWidth = 5;
  context.lineJoin = 'round';
  context.stroke();
  context.fillStyle = colors.home;
  context.fill();
};
