// Which part of the screen something takes, in pixels.

import type { LatLon } from '../model/plan';
import type { Mark } from '../model/ports';
import type { Box, Pixels, View } from './canvas';
import { line_to } from './mark_painter';
import { to_plane, units_per_m, type PlanePoint } from './projection';

export const whole = ({ width_px, height_px }: View): Box => ({
  left: 0,
  top: 0,
  right: width_px,
  bottom: height_px,
});

export const around_px = (x: number, y: number, reach_px: number): Box => ({
  left: x - reach_px,
  top: y - reach_px,
  right: x + reach_px,
  bottom: y + reach_px,
});

/** @param margin_px around them @return null: there are none */
export const box_of = (
  pixels: Pixels,
  places: Iterable<PlanePoint>,
  margin_px: number,
): Box | null => {
  let [left, top, right, bottom] = [Infinity, Infinity, -Infinity, -Infinity];
  for (const [plane_x, plane_y] of places) {
    const [x, y] = [pixels.x_px(plane_x), pixels.y_px(plane_y)];
    [left, right] = [Math.min(left, x), Math.max(right, x)];
    [top, bottom] = [Math.min(top, y), Math.max(bottom, y)];
  }
  if (left > right) return null;
  return {
    left: left - margin_px,
    top: top - margin_px,
    right: right + margin_px,
    bottom: bottom + margin_px,
  };
};

/** Of arrow and ring around a goal. */
const GOAL_PX = 60;

/** A goal, what is around it, and the way to it. */
export const goal_box = (pixels: Pixels, goal: Mark, from: LatLon | null): Box | null => {
  const ring_m = goal.ring?.radius_m ?? 0;
  const ring_px = (ring_m * units_per_m(goal.lat).east) / pixels.resolution;
  const places = [to_plane(goal), ...line_to(goal, from)];
  return box_of(pixels, places, GOAL_PX + ring_px);
};
