// Draws the place that the person chose, and where the robot drives to outside of a mission.

import { circle_way } from '../model/circle';
import type { LatLon } from '../model/plan';
import type { Mark } from '../model/ports';
import { stand_at, stroke_cased, type Paint } from './canvas';
import type { Palette } from './palette';
import { to_plane, units_per_m, type PlanePoint } from './projection';
import { paint_ring_arrows, paint_ring_line } from './ring_painter';

const PIN_PX = 15;
const FACING_PX = 46;

/** Farther outside of its circle than this the robot still drives to it. */
const AWAY_M = 0.6;

const place = (paint: Paint, at: LatLon): readonly [x: number, y: number] => {
  const [x, y] = to_plane(at);
  return [paint.x_px(x), paint.y_px(y)];
};

/** An arrow from the place: how the robot faces there. */
const paint_facing = (paint: Paint, at: Mark, color: string, casing: string): void => {
  if (at.heading_deg === null) return;
  const { context } = paint;
  const [x, y] = place(paint, at);
  context.save();
  context.translate(x, y);
  context.rotate((at.heading_deg * Math.PI) / 180);
  context.beginPath();
  context.moveTo(0, 0);
  context.lineTo(0, -FACING_PX);
  context.moveTo(-9, -FACING_PX + 11);
  context.lineTo(0, -FACING_PX);
  context.lineTo(9, -FACING_PX + 11);
  stroke_cased(context, casing, color, 4);
  context.restore();
};

const paint_round = (paint: Paint, at: Mark, color: string, casing: string): void => {
  if (!at.ring) return;
  const [x, y] = place(paint, at);
  const { radius_m, clockwise } = at.ring;
  const r = (radius_m * units_per_m(at.lat).east) / paint.resolution;
  const look = { clockwise, line_px: clockwise === null ? null : 3.5, color, casing };
  paint_ring_line(paint, x, y, r, look);
  paint_ring_arrows(paint, x, y, r, look);
};

/** Where the way to a mark leads, from the robot. */
export const line_to = (goal: Mark, from: LatLon | null): readonly PlanePoint[] => {
  if (goal.line) return goal.line.map(to_plane);
  if (!from) return [];
  const start = to_plane(from);
  const centre = to_plane(goal);
  const clockwise = goal.ring?.clockwise ?? null;
  if (!goal.ring || clockwise === null) return [start, centre];
  // Around a place: along the tangent.
  const scale = units_per_m(goal.lat).east;
  const radius = goal.ring.radius_m * scale;
  const wish = { radius, clockwise, turns: 1, on: AWAY_M * scale };
  const way = circle_way(wish, [start[0] - centre[0], start[1] - centre[1]]);
  if (!way.tangent) return [];
  const { from_rad } = way;
  return [
    start,
    [centre[0] + radius * Math.cos(from_rad), centre[1] + radius * Math.sin(from_rad)],
  ];
};

const paint_line = (
  paint: Paint,
  line: readonly PlanePoint[],
  color: string,
  casing: string,
): void => {
  if (line.length < 2) return;
  const { context } = paint;
  context.beginPath();
  line.forEach(([x, y], k) => {
    if (k === 0) context.moveTo(paint.x_px(x), paint.y_px(y));
    else context.lineTo(paint.x_px(x), paint.y_px(y));
  });
  context.setLineDash([10, 8]);
  stroke_cased(context, casing, color, 3);
  context.setLineDash([]);
};

/** A drop that stands with its tip on the place; with a line there, if it has one. */
export const paint_pin = (paint: Paint, pin: Mark, colors: Palette): void => {
  const { context } = paint;
  if (pin.line) paint_line(paint, pin.line.map(to_plane), colors.selected, colors.casing);
  paint_round(paint, pin, colors.selected, colors.casing);
  paint_facing(paint, pin, colors.selected, colors.casing);
  stand_at(paint, ...place(paint, pin));
  const top = -2.2 * PIN_PX;
  context.beginPath();
  context.moveTo(0, 0);
  context.quadraticCurveTo(-PIN_PX, top + PIN_PX, -PIN_PX, top);
  context.arc(0, top, PIN_PX, Math.PI, 0);
  context.quadraticCurveTo(PIN_PX, top + PIN_PX, 0, 0);
  context.closePath();
  context.strokeStyle = colors.casing;
  context.lineWidth = 5;
  context.lineJoin = 'round';
  context.stroke();
  context.fillStyle = colors.selected;
  context.fill();
  context.beginPath();
  context.arc(0, top, 5.5, 0, 2 * Math.PI);
  context.fillStyle = colors.on_point;
  context.fill();
};

/** A ring, and a dashed line to it from the robot. */
export const paint_goal = (
  paint: Paint,
  goal: Mark,
  from: LatLon | null,
  colors: Palette,
): void => {
  const { context } = paint;
  const [x, y] = place(paint, goal);
  paint_round(paint, goal, colors.route, colors.casing);
  paint_line(paint, line_to(goal, from), colors.route, colors.casing);
  paint_facing(paint, goal, colors.route, colors.casing);
  context.beginPath();
  context.arc(x, y, 13, 0, 2 * Math.PI);
  stroke_cased(context, colors.casing, colors.current, 4.5);
};
