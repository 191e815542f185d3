// Draws where the device is that shows the page, and how far off that may be.

import type { MeOnMap } from '../model/me';
import { around_px } from './boxes';
import type { Box, Paint, Pixels } from './canvas';
import type { Palette } from './palette';
import { to_plane, units_per_m } from './projection';

const DOT_PX = 8;
const CASING_PX = 3;

const reach_px = ({ resolution }: Pixels, me: MeOnMap): number =>
  (me.accuracy_m * units_per_m(me.lat).east) / resolution;

export const me_box = (pixels: Pixels, me: MeOnMap): Box => {
  const [x, y] = to_plane(me);
  const most_px = Math.max(reach_px(pixels, me), DOT_PX + CASING_PX);
  return around_px(pixels.x_px(x), pixels.y_px(y), most_px + 2);
};

/** Blue and round, as every map shows it; old: hollow and grey. */
export const paint_me = (paint: Paint, me: MeOnMap, colors: Palette): void => {
  const { context } = paint;
  const [plane_x, plane_y] = to_plane(me);
  const [x, y] = [paint.x_px(plane_x), paint.y_px(plane_y)];
  const color = me.old ? colors.robot_stale : colors.plan;
  context.beginPath();
  context.arc(x, y, reach_px(paint, me), 0, 2 * Math.PI);
  context.fillStyle = colors.ring;
  if (!me.old) context.fill();
  context.strokeStyle = color;
  context.lineWidth = 1.5;
  context.stroke();
  context.beginPath();
  context.arc(x, y, DOT_PX, 0, 2 * Math.PI);
  context.fillStyle = me.old ? colors.casing : color;
  context.strokeStyle = me.old ? color : colors.casing;
  context.lineWidth = CASING_PX;
  context.fill();
  context.stroke();
};
