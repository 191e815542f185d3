// Draws a drill: where the failures begin, the ways from there, and the places where the robot would
// stand, to scale. Broken lines and hollow bodies: nothing of it is real.

import type { DrilledPlace, DrillOnMap } from '../model/drill';
import type { LatLon } from '../model/plan';
import { stand_at, stroke_cased, trace, type Paint } from './canvas';
import type { Palette } from './palette';
import { to_plane, to_plane_line, units_per_m, type PlaneLine } from './projection';
import type { Size } from './robot_painter';

const DOT_PX = 4;
const CROSS_PX = 8;
/** The words stand above the body and its way. */
const LABEL_PX = 18;
/** A smaller body is a dot. */
const BODY_FROM_PX = 8;

/** A place, projected once. */
interface DrawnPlace {
  readonly place: DrilledPlace;
  readonly line: PlaneLine;
}
export interface DrawnDrill {
  readonly begins: LatLon | null;
  readonly places: readonly DrawnPlace[];
}

export const prepare_drill = (drill: DrillOnMap): DrawnDrill => ({
  begins: drill.begins,
  // The one that is looked at comes last, above the others.
  places: [...drill.places]
    .sort((a, b) => Number(a.chosen) - Number(b.chosen))
    .map((place) => ({ place, line: to_plane_line(place.line) })),
});

const color_of = ({ tone }: DrilledPlace, colors: Palette): string => {
  if (tone === 'bad') return colors.refused;
  return tone === 'on' ? colors.current : colors.plan;
};

const paint_way = (paint: Paint, { line, place }: DrawnPlace, colors: Palette): void => {
  const { context } = paint;
  context.beginPath();
  trace(paint, line.xs, line.ys);
  context.setLineDash([4, 4]);
  if (place.chosen) stroke_cased(context, colors.casing, color_of(place, colors), 3.5);
  else {
    context.strokeStyle = color_of(place, colors);
    context.lineWidth = 1.5;
    context.stroke();
  }
  context.setLineDash([]);
};

/** Length and width on the screen. */
const body_px = ({ resolution }: Paint, { lat }: LatLon, size: Size): readonly [number, number] => {
  const metre_px = units_per_m(lat).east / resolution;
  return [size.length_m * metre_px, size.width_m * metre_px];
};

/** @param alone another one is looked at: only a dot */
const paint_body = (
  paint: Paint,
  place: DrilledPlace,
  alone: boolean,
  size: Size,
  colors: Palette,
): void => {
  const { context } = paint;
  const [x, y] = to_plane(place);
  const [long_px, wide_px] = body_px(paint, place, size);
  const color = color_of(place, colors);
  context.save();
  context.translate(paint.x_px(x), paint.y_px(y));
  context.rotate((place.heading_deg * Math.PI) / 180);
  context.beginPath();
  if (long_px >= BODY_FROM_PX && (place.chosen || !alone)) {
    context.rect(-wide_px / 2, -long_px / 2, wide_px, long_px);
    context.moveTo(-wide_px / 4, -long_px / 4);
    context.lineTo(0, -long_px / 2);
    context.lineTo(wide_px / 4, -long_px / 4);
    if (place.chosen) stroke_cased(context, colors.casing, color, 3);
    else {
      context.strokeStyle = color;
      context.lineWidth = 1.5;
      context.stroke();
    }
    context.beginPath();
  }
  context.arc(0, 0, place.chosen ? DOT_PX + 2 : DOT_PX, 0, 2 * Math.PI);
  context.fillStyle = color;
  context.fill();
  context.restore();
};

const paint_label = (paint: Paint, place: DrilledPlace, size: Size, colors: Palette): void => {
  const { context } = paint;
  const [x, y] = to_plane(place);
  const above_px = Math.hypot(...body_px(paint, place, size)) / 2 + LABEL_PX;
  context.save();
  stand_at(paint, paint.x_px(x), paint.y_px(y));
  context.font = '700 14px system-ui, sans-serif';
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.lineJoin = 'round';
  context.strokeStyle = colors.casing;
  context.lineWidth = 5;
  context.strokeText(place.label, 0, -above_px);
  context.fillStyle = color_of(place, colors);
  context.fillText(place.label, 0, -above_px);
  context.restore();
};

/** A cross: there it fails. */
const paint_begin = (paint: Paint, at: LatLon, colors: Palette): void => {
  const { context } = paint;
  const [x, y] = to_plane(at);
  const [x_px, y_px] = [paint.x_px(x), paint.y_px(y)];
  context.beginPath();
  context.moveTo(x_px - CROSS_PX, y_px - CROSS_PX);
  context.lineTo(x_px + CROSS_PX, y_px + CROSS_PX);
  context.moveTo(x_px - CROSS_PX, y_px + CROSS_PX);
  context.lineTo(x_px + CROSS_PX, y_px - CROSS_PX);
  stroke_cased(context, colors.casing, colors.refused, 4);
};

export const paint_drill = (paint: Paint, drill: DrawnDrill, size: Size, colors: Palette): void => {
  for (const drawn of drill.places) paint_way(paint, drawn, colors);
  const alone = drill.places.some(({ place }) => place.chosen);
  for (const { place } of drill.places) paint_body(paint, place, alone, size, colors);
  if (drill.begins) paint_begin(paint, drill.begins, colors);
  for (const { place } of drill.places) if (place.chosen) paint_label(paint, place, size, colors);
};
