// Draws fences: areas to stay in, areas to keep out of, and rally points.

import type { FenceArea, FenceDraft } from '../model/fence';
import type { LatLon } from '../model/plan';
import { stroke_cased, type Paint } from './canvas';
import type { Palette } from './palette';
import { to_plane, units_per_m } from './projection';

const place = (paint: Paint, at: LatLon): readonly [x: number, y: number] => {
  const [x, y] = to_plane(at);
  return [paint.x_px(x), paint.y_px(y)];
};

const trace_area = (paint: Paint, { polygon, circle }: FenceArea): void => {
  const { context, resolution } = paint;
  context.beginPath();
  if (circle) {
    const [x, y] = place(paint, circle);
    const units = units_per_m(circle.lat);
    const [wide_px, high_px] = [
      (circle.radius_m * units.east) / resolution,
      (circle.radius_m * units.north) / resolution,
    ];
    context.ellipse(x, y, wide_px, high_px, 0, 0, 2 * Math.PI);
    return;
  }
  polygon?.forEach((corner, k) => {
    const [x, y] = place(paint, corner);
    if (k === 0) context.moveTo(x, y);
    else context.lineTo(x, y);
  });
  context.closePath();
};

/** A small flag. */
const paint_rally = (paint: Paint, at: LatLon, colors: Palette): void => {
  const { context } = paint;
  const [x, y] = place(paint, at);
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(x, y - 24);
  context.lineTo(x + 16, y - 18);
  context.lineTo(x, y - 12);
  stroke_cased(context, colors.casing, colors.home, 3);
  context.fillStyle = colors.home;
  context.fill();
};

export const paint_fence = (paint: Paint, fence: FenceDraft, colors: Palette): void => {
  const { context } = paint;
  for (const area of fence.areas) {
    trace_area(paint, area);
    const keep_out = area.kind === 'exclusion';
    if (keep_out) {
      context.fillStyle = colors.keep_out;
      context.fill();
    }
    context.setLineDash(keep_out ? [] : [14, 7]);
    stroke_cased(context, colors.casing, keep_out ? colors.refused : colors.stay_in, 3);
    context.setLineDash([]);
  }
  for (const at of fence.rally) paint_rally(paint, at, colors);
};
