// Draws where the ground gave way: a diamond, the fuller the worse; dug in: crossed.

import type { Slip } from '../model/slips';
import type { Paint } from './canvas';
import type { Palette } from './palette';
import { to_plane, type PlanePoint } from './projection';

export interface DrawnSlip {
  readonly at: PlanePoint;
  readonly slip: Slip;
}

const SIZE_PX = 8;
const CROSS_PX = 4;
const OFF_SCREEN_PX = 20;

export const prepare_slips = (slips: readonly Slip[]): readonly DrawnSlip[] =>
  slips.map((slip) => ({ at: to_plane(slip), slip }));

export const paint_slips = (paint: Paint, drawn: readonly DrawnSlip[], colors: Palette): void => {
  const { context, width_px, height_px } = paint;
  context.save();
  context.lineWidth = 2.5;
  for (const { at, slip } of drawn) {
    const x = paint.x_px(at[0]);
    const y = paint.y_px(at[1]);
    const seen =
      x > -OFF_SCREEN_PX &&
      y > -OFF_SCREEN_PX &&
      x < width_px + OFF_SCREEN_PX &&
      y < height_px + OFF_SCREEN_PX;
    if (!seen) continue;
    context.beginPath();
    context.moveTo(x, y - SIZE_PX);
    context.lineTo(x + SIZE_PX, y);
    context.lineTo(x, y + SIZE_PX);
    context.lineTo(x - SIZE_PX, y);
    context.closePath();
    context.fillStyle = colors.casing;
    context.fill();
    context.globalAlpha = Math.min(0.85, 0.2 + slip.percent / 100);
    context.fillStyle = colors.refused;
    context.fill();
    context.globalAlpha = 1;
    context.strokeStyle = colors.refused;
    context.stroke();
    if (slip.kind !== 'dug') continue;
    context.beginPath();
    context.moveTo(x - CROSS_PX, y - CROSS_PX);
    context.lineTo(x + CROSS_PX, y + CROSS_PX);
    context.moveTo(x + CROSS_PX, y - CROSS_PX);
    context.lineTo(x - CROSS_PX, y + CROSS_PX);
    context.strokeStyle = colors.on_point;
    context.stroke();
  }
  context.restore();
};
