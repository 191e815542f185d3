// Draws the ground that a calibration drive needs.

import type { SpaceOnMap } from '../model/calibration';
import { stroke_cased, trace, type Paint } from './canvas';
import type { Palette } from './palette';
import { to_plane_line, type PlaneLine } from './projection';

export interface DrawnSpace {
  readonly line: PlaneLine;
  readonly possible: boolean;
}

export const prepare_space = ({ corners, possible }: SpaceOnMap): DrawnSpace => ({
  line: to_plane_line(corners),
  possible,
});

export const paint_space = (
  paint: Paint,
  { line, possible }: DrawnSpace,
  colors: Palette,
): void => {
  if (line.xs.length < 3) return;
  const { context } = paint;
  context.beginPath();
  trace(paint, line.xs, line.ys);
  context.closePath();
  context.fillStyle = possible ? colors.ring : colors.keep_out;
  context.fill();
  context.setLineDash([9, 7]);
  stroke_cased(context, colors.casing, possible ? colors.plan : colors.refused, 2.5);
};
