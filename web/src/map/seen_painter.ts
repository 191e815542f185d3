// Draws what the sensors see: the ground as far as it is known, the last points of each sensor, the
// things that stand there, and over which ground the robot is about to come. What matters is told by
// pattern and shape as well as by colour: solid is occupied, stripes are a drop, a hatch is unknown.

import {
  cells_of,
  DROP,
  FREE,
  OCCUPIED,
  signed_things,
  type AheadOnMap,
  type SeenGrid,
  type SeenOnMap,
  type SeenThing,
  type SensorDots,
} from '../model/seen';
import type { LatLon } from '../model/plan';
import { stroke_cased, type Paint } from './canvas';
import { is_dark, type Palette } from './palette';
import { to_plane, units_per_m } from './projection';

type Rgba = readonly [red: number, green: number, blue: number, alpha: number];
interface Ground {
  readonly occupied: Rgba;
  readonly drop: Rgba;
  readonly drop_gap: Rgba;
  readonly free: Rgba;
  readonly unknown: Rgba;
  readonly hatch: Rgba;
}
const light: Ground = {
  occupied: [160, 60, 0, 240],
  drop: [104, 30, 130, 240],
  drop_gap: [104, 30, 130, 70],
  free: [0, 114, 178, 34],
  unknown: [70, 66, 52, 26],
  hatch: [70, 66, 52, 84],
};
const dark: Ground = {
  occupied: [255, 150, 80, 240],
  drop: [226, 160, 255, 240],
  drop_gap: [226, 160, 255, 70],
  free: [124, 190, 255, 46],
  unknown: [214, 222, 235, 16],
  hatch: [214, 222, 235, 60],
};
/** Stripes of unknown ground, cells. */
const HATCH_CELLS = 8;

const color_of = (known: number, column: number, row: number, colors: Ground): Rgba => {
  if (known === OCCUPIED) return colors.occupied;
  if (known === FREE) return colors.free;
  if (known === DROP) return (column + row) % 3 === 0 ? colors.drop_gap : colors.drop;
  return (column - row + HATCH_CELLS * 1000) % HATCH_CELLS === 0 ? colors.hatch : colors.unknown;
};

const picture_of = (grid: SeenGrid, colors: Ground): HTMLCanvasElement | null => {
  const cells = cells_of(grid);
  const canvas = document.createElement('canvas');
  const context = canvas.getContext('2d');
  if (!cells || !context || cells.length === 0) return null;
  canvas.width = grid.columns;
  canvas.height = grid.rows;
  const image = context.createImageData(grid.columns, grid.rows);
  for (let k = 0; k < cells.length; k += 1) {
    const row = Math.floor(k / grid.columns);
    image.data.set(color_of(cells[k] ?? 0, k - row * grid.columns, row, colors), 4 * k);
  }
  context.putImageData(image, 0, 0);
  return canvas;
};

/** The last picture: a grid comes twice a second, and is drawn at every frame. */
let kept: { grid: SeenGrid; dark: boolean; picture: HTMLCanvasElement | null } | null = null;

const kept_picture = (grid: SeenGrid): HTMLCanvasElement | null => {
  const night = is_dark();
  if (kept?.grid !== grid || kept.dark !== night) {
    kept = { grid, dark: night, picture: picture_of(grid, night ? dark : light) };
  }
  return kept.picture;
};

export const paint_ground = (paint: Paint, grid: SeenGrid | null): void => {
  if (!grid?.at) return;
  const picture = kept_picture(grid);
  if (!picture) return;
  const { context, resolution } = paint;
  const [x, y] = to_plane(grid.at);
  const heading = (grid.at.heading_deg * Math.PI) / 180;
  const cell_px = (grid.cell_m * units_per_m(grid.at.lat).east) / resolution;
  const [right, down] = [Math.sin(heading) * cell_px, -Math.cos(heading) * cell_px];
  context.imageSmoothingEnabled = false;
  // A column further is along the heading, a row further to its left.
  context.transform(right, down, down, -right, paint.x_px(x), paint.y_px(y));
  context.drawImage(picture, 0, 0);
};

type Px = readonly [x: number, y: number];
const px = (paint: Paint, at: LatLon): Px => {
  const [x, y] = to_plane(at);
  return [paint.x_px(x), paint.y_px(y)];
};

/** Ahead and left in centimetres, to pixels. */
type ToPixel = (ahead_cm: number, left_cm: number) => Px;

const body_to_pixel = (paint: Paint, at: LatLon, heading_deg: number): ToPixel => {
  const [x0, y0] = px(paint, at);
  const heading = (heading_deg * Math.PI) / 180;
  const cm_px = (0.01 * units_per_m(at.lat).east) / paint.resolution;
  const [sin, cos] = [Math.sin(heading) * cm_px, Math.cos(heading) * cm_px];
  return (ahead, left) => [x0 + ahead * sin - left * cos, y0 - ahead * cos - left * sin];
};

const DOT_PX = 3;
const RING_PX = 2.5;
const CROSS_PX = 3;

const each_dot = (dots: readonly number[], to: ToPixel, draw: (x: number, y: number) => void) => {
  for (let k = 0; k + 1 < dots.length; k += 2) draw(...to(dots[k] ?? 0, dots[k + 1] ?? 0));
};

/** Squares stand there, rings hang above, crosses are edges, small dots are rain and dust. */
const paint_dots = (paint: Paint, dots: SensorDots, to: ToPixel, colors: Palette): void => {
  const { context } = paint;
  context.beginPath();
  each_dot(dots.obstacle_cm, to, (x, y) =>
    context.rect(x - DOT_PX / 2, y - DOT_PX / 2, DOT_PX, DOT_PX),
  );
  context.fillStyle = colors.plan;
  context.fill();
  context.beginPath();
  each_dot(dots.overhang_cm, to, (x, y) => {
    context.moveTo(x + RING_PX, y);
    context.arc(x, y, RING_PX, 0, 2 * Math.PI);
  });
  context.strokeStyle = colors.plan;
  context.lineWidth = 1;
  context.stroke();
  context.lineWidth = 1.5;
  context.beginPath();
  each_dot(dots.drop_cm, to, (x, y) => {
    context.moveTo(x - CROSS_PX, y - CROSS_PX);
    context.lineTo(x + CROSS_PX, y + CROSS_PX);
    context.moveTo(x + CROSS_PX, y - CROSS_PX);
    context.lineTo(x - CROSS_PX, y + CROSS_PX);
  });
  context.strokeStyle = colors.home;
  context.stroke();
  context.beginPath();
  each_dot(dots.passing_cm, to, (x, y) => context.rect(x - 1, y - 1, 2, 2));
  context.fillStyle = colors.grid_label;
  context.fill();
};

const THING_PX = 7;

/** A triangle at the place that is nearest to the robot; full: it is on the way. */
const paint_thing = (paint: Paint, thing: SeenThing, [x, y]: Px, colors: Palette): void => {
  const { context } = paint;
  context.beginPath();
  context.moveTo(x, y - THING_PX);
  context.lineTo(x + THING_PX, y + THING_PX * 0.8);
  context.lineTo(x - THING_PX, y + THING_PX * 0.8);
  context.closePath();
  context.fillStyle = thing.on_way ? colors.refused : colors.casing;
  stroke_cased(context, colors.casing, colors.refused, 2);
  context.fill();
};

export const paint_seen = (paint: Paint, seen: SeenOnMap, colors: Palette): void => {
  const at = seen.scan?.at;
  if (at) {
    const to = body_to_pixel(paint, at, at.heading_deg);
    for (const dots of seen.scan?.sensors ?? []) paint_dots(paint, dots, to, colors);
  }
  const places = new Map<SeenThing, Px>();
  for (const thing of seen.things) {
    const { lat, lon } = thing;
    if (lat !== null && lon !== null) places.set(thing, px(paint, { lat, lon }));
  }
  const apart = (one: SeenThing, other: SeenThing): boolean => {
    const [x0, y0] = places.get(one) ?? [0, 0];
    const [x1, y1] = places.get(other) ?? [0, 0];
    return Math.hypot(x1 - x0, y1 - y0) > 2.5 * THING_PX;
  };
  for (const thing of signed_things([...places.keys()], apart)) {
    const at_px = places.get(thing);
    if (at_px) paint_thing(paint, thing, at_px, colors);
  }
};

const trace_ring = (paint: Paint, ring: readonly LatLon[]): void => {
  ring.forEach((at, k) => {
    const [x, y] = px(paint, at);
    if (k === 0) paint.context.moveTo(x, y);
    else paint.context.lineTo(x, y);
  });
  paint.context.closePath();
};

/** The ground under the next metres, the room that is kept free at their end, and the way around. */
export const paint_ahead = (paint: Paint, ahead: AheadOnMap, colors: Palette): void => {
  const { context } = paint;
  if (ahead.sweep) {
    context.beginPath();
    for (const ring of ahead.sweep.outlines) trace_ring(paint, ring);
    context.fillStyle = colors.wedge;
    context.fill('nonzero');
    context.beginPath();
    trace_ring(paint, ahead.sweep.margin);
    context.setLineDash([6, 5]);
    stroke_cased(context, colors.casing, colors.current, 2);
    context.setLineDash([]);
  }
  if (ahead.detour.length < 2) return;
  context.beginPath();
  ahead.detour.forEach((at, k) => {
    const [x, y] = px(paint, at);
    if (k === 0) context.moveTo(x, y);
    else context.lineTo(x, y);
  });
  context.setLineDash([12, 8]);
  stroke_cased(context, colors.casing, colors.selected, 4);
  context.setLineDash([]);
};

const BLOCK_PX = 10;

/** A road sign: a full disc with a bar where it stops, a ring where it only slows. */
export const paint_block = (paint: Paint, { block }: AheadOnMap, colors: Palette): void => {
  if (!block) return;
  const { context } = paint;
  const [x, y] = px(paint, block);
  context.beginPath();
  context.arc(x, y, BLOCK_PX, 0, 2 * Math.PI);
  context.fillStyle = block.stops ? colors.refused : colors.casing;
  stroke_cased(context, colors.casing, block.stops ? colors.refused : colors.current, 4);
  context.fill();
  if (!block.stops) return;
  context.fillStyle = colors.on_point;
  context.fillRect(x - BLOCK_PX * 0.6, y - 2.5, BLOCK_PX * 1.2, 5);
};
