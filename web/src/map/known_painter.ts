// Draws what the robot knows itself by: a square with the tag's number, a disc for a pole, and a line
// to where it was seen, where that is elsewhere.

import { offset_from } from '../model/geo';
import { known_tone, type KnownPlace } from '../model/known_places';
import { stand_at, type Paint } from './canvas';
import type { Palette } from './palette';
import { to_plane, type PlanePoint } from './projection';

export interface DrawnKnown {
  readonly at: PlanePoint;
  readonly place: KnownPlace;
  /** Where it was seen; null: nowhere else. */
  readonly seen: PlanePoint | null;
}

const HALF_PX = 9;
const LOOKS_PX = 20;
const NAME_PX = 18;
/** Seen elsewhere: beyond what is known of it. */
const SIGMAS = 3;

const seen_at = (place: KnownPlace): PlanePoint | null => {
  const { off_m, off_direction_deg, sigma_m } = place;
  if (off_m === null || off_direction_deg === null || off_m <= SIGMAS * (sigma_m ?? 0)) return null;
  const to = (off_direction_deg * Math.PI) / 180;
  return to_plane(
    offset_from(place, { east_m: off_m * Math.sin(to), north_m: off_m * Math.cos(to) }),
  );
};

export const prepare_known = (places: readonly KnownPlace[]): readonly DrawnKnown[] =>
  places.map((place) => ({ at: to_plane(place), place, seen: seen_at(place) }));

const body = (context: CanvasRenderingContext2D, tag: boolean): void => {
  context.beginPath();
  if (tag) context.rect(-HALF_PX, -HALF_PX, 2 * HALF_PX, 2 * HALF_PX);
  else context.arc(0, 0, HALF_PX, 0, 2 * Math.PI);
};

export const paint_known = (paint: Paint, drawn: readonly DrawnKnown[], colors: Palette): void => {
  const { context, width_px, height_px } = paint;
  const off_screen = LOOKS_PX + 10;
  context.save();
  context.font = '600 12px system-ui, sans-serif';
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  for (const { at, place, seen } of drawn) {
    const x = paint.x_px(at[0]);
    const y = paint.y_px(at[1]);
    if (x < -off_screen || y < -off_screen) continue;
    if (x > width_px + off_screen || y > height_px + off_screen) continue;
    const tone = known_tone(place);
    const color =
      tone === 'good' ? colors.route : tone === 'bad' ? colors.refused : colors.grid_label;
    context.strokeStyle = color;
    context.lineWidth = 2.5;
    context.beginPath();
    if (place.heading_deg !== null) {
      const to = (place.heading_deg * Math.PI) / 180;
      context.moveTo(x, y);
      context.lineTo(x + LOOKS_PX * Math.sin(to), y - LOOKS_PX * Math.cos(to));
    }
    if (seen) {
      context.moveTo(x, y);
      context.lineTo(paint.x_px(seen[0]), paint.y_px(seen[1]));
    }
    context.stroke();
    context.save();
    stand_at(paint, x, y);
    body(context, place.tag !== null);
    context.fillStyle = tone === 'none' ? colors.casing : color;
    context.fill();
    context.stroke();
    context.fillStyle = tone === 'none' ? color : colors.on_point;
    context.fillText(place.tag === null ? '' : String(place.tag), 0, 0);
    context.lineWidth = 3;
    context.strokeStyle = colors.casing;
    context.strokeText(place.name, 0, NAME_PX);
    context.fillStyle = color;
    context.fillText(place.name, 0, NAME_PX);
    context.restore();
  }
  context.restore();
};
