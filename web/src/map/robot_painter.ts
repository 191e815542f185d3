// Draws the robot, how sure it is of place and heading, and home.

import type { LatLon } from '../model/plan';
import type { RobotOnMap } from '../model/ports';
import { around_px } from './boxes';
import { stand_at, stroke_cased, type Box, type Paint, type Pixels } from './canvas';
import type { Palette } from './palette';
import { to_plane, units_per_m } from './projection';

const ARROW_PX = 19;
/** Half the room of the words under it. */
const WORDS_PX = 64;

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

/** Its half axes. */
const ellipse_of = (robot: RobotOnMap): NonNullable<RobotOnMap['ellipse']> => {
  const round_m = robot.accuracy_m ?? 0;
  return robot.ellipse ?? { major_m: round_m, minor_m: round_m, orientation_deg: 0 };
};

export const accuracy_box = (pixels: Pixels, robot: RobotOnMap): Box | null => {
  const long_px = (ellipse_of(robot).major_m * units_per_m(robot.at.lat).east) / pixels.resolution;
  const [x, y] = to_plane(robot.at);
  return long_px <= 4 ? null : around_px(pixels.x_px(x), pixels.y_px(y), long_px + 2);
};

/** With the words under it. */
export const robot_box = (pixels: Pixels, robot: RobotOnMap, size: Size): Box => {
  const metre_px = units_per_m(robot.at.lat).east / pixels.resolution;
  const body_px = (Math.hypot(size.length_m, size.width_m) / 2) * metre_px;
  const [x, y] = to_plane(robot.at);
  const least_px = robot.old === null && robot.fence === null ? ARROW_PX + 4 : WORDS_PX;
  return around_px(pixels.x_px(x), pixels.y_px(y), Math.max(least_px, body_px) + 6);
};

/** How far off the robot may be. Under everything else, which it must not tint: it can be wide. */
export const paint_accuracy = (paint: Paint, robot: RobotOnMap, colors: Palette): void => {
  const { context, resolution } = paint;
  const [x, y] = to_plane(robot.at);
  const metre_px = units_per_m(robot.at.lat).east / resolution;
  const { major_m, minor_m, orientation_deg } = ellipse_of(robot);
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

/** 1σ, where it is worth a wedge; else null. */
const wedge_deg = ({ stale, heading_deg, heading_accuracy_deg }: RobotOnMap): number | null => {
  const sigma_deg = stale || heading_deg === null ? 0 : (heading_accuracy_deg ?? 0);
  return sigma_deg < WEDGE_FROM_DEG ? null : sigma_deg;
};

export const wedge_box = (pixels: Pixels, robot: RobotOnMap): Box | null => {
  const [x, y] = to_plane(robot.at);
  return wedge_deg(robot) === null ? null : around_px(pixels.x_px(x), pixels.y_px(y), WEDGE_PX + 2);
};

/** How far off the heading may be, to both sides of it, two sigma. Under everything else, too. */
export const paint_wedge = (paint: Paint, robot: RobotOnMap, color: string): void => {
  const { context } = paint;
  const [x, y] = to_plane(robot.at);
  const half = (Math.min(2 * (wedge_deg(robot) ?? 0), 180) * Math.PI) / 180;
  context.translate(paint.x_px(x), paint.y_px(y));
  context.rotate(((robot.heading_deg ?? 0) * Math.PI) / 180);
  context.beginPath();
  context.moveTo(0, 0);
  context.arc(0, 0, WEDGE_PX, -Math.PI / 2 - half, -Math.PI / 2 + half);
  context.closePath();
  context.fillStyle = color;
  context.fill();
};

/** Under the robot: how long ago that was, and how near the fence is. */
const paint_words = (
  context: CanvasRenderingContext2D,
  words: string,
  y: number,
  colors: Palette,
): void => {
  context.font = '700 13px system-ui, sans-serif';
  context.textAlign = 'center';
  context.textBaseline = 'top';
  context.lineJoin = 'round';
  context.strokeStyle = colors.casing;
  context.lineWidth = 4;
  context.strokeText(words, 0, y);
  context.fillStyle = colors.refused;
  context.fillText(words, 0, y);
};

export const paint_robot = (paint: Paint, robot: RobotOnMap, size: Size, colors: Palette): void => {
  const { context, resolution } = paint;
  const [x, y] = to_plane(robot.at);
  const metre_px = units_per_m(robot.at.lat).east / resolution;
  const color = robot.stale ? colors.robot_stale : colors.robot;
  context.save();
  stand_at(paint, paint.x_px(x), paint.y_px(y));
  if (robot.old !== null) paint_words(context, robot.old, 26, colors);
  if (robot.fence !== null) paint_words(context, robot.fence, robot.old === null ? 26 : 42, colors);
  context.restore();

  context.translate(paint.x_px(x), paint.y_px(y));
  if (robot.heading_deg === null) {
    context.beginPath();
    context.arc(0, 0, 11, 0, 2 * Math.PI);
    stroke_cased(context, colors.casing, color, 5);
    return;
  }
  context.rotate((robot.heading_deg * Math.PI) / 180);
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
  stand_at(paint, paint.x_px(x), paint.y_px(y));
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
