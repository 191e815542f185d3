// Draws the map of a place below everything else: what stands there is dark, free ground light, and
// what nobody has seen a faint shade; and what a hand changes in it, each kind by its own pattern.

import { FORBIDDEN_CELL, FREE_CELL, OCCUPIED_CELL, type SiteCells } from '../model/site_cells';
import { type EditKind, type SiteEdit, type SiteOnMap } from '../model/site_map';
import type { LatLon } from '../model/plan';
import { stroke_cased, type Paint } from './canvas';
import { is_dark, type Palette } from './palette';
import { to_plane, units_per_m } from './projection';

export { paint_graph } from './graph_painter'; // it lies on such a map

interface Shades {
  readonly occupied: number;
  readonly free: number;
  readonly unknown: number;
  /** Stripes of two. */
  readonly forbidden: readonly [stripe: number, between: number];
}
/** As a pixel lies in memory: alpha, blue, green, red. */
const rgba = (red: number, green: number, blue: number, alpha: number): number =>
  ((alpha << 24) | (blue << 16) | (green << 8) | red) >>> 0;
const light: Shades = {
  occupied: rgba(38, 36, 44, 255),
  free: rgba(255, 255, 255, 190),
  unknown: rgba(70, 66, 52, 30),
  forbidden: [rgba(179, 38, 30, 230), rgba(179, 38, 30, 60)],
};
const dark: Shades = {
  occupied: rgba(232, 226, 240, 255),
  free: rgba(58, 64, 76, 200),
  unknown: rgba(0, 0, 0, 70),
  forbidden: [rgba(255, 138, 128, 230), rgba(255, 138, 128, 60)],
};
const STRIPE_CELLS = 4;
const RAD = Math.PI / 180;

/** @param diagonal the same on a line that falls to the left */
const shade_of = (kind: number, diagonal: number, shades: Shades): number => {
  if (kind === OCCUPIED_CELL) return shades.occupied;
  if (kind === FREE_CELL) return shades.free;
  if (kind === FORBIDDEN_CELL) return shades.forbidden[diagonal % STRIPE_CELLS === 0 ? 0 : 1];
  return shades.unknown;
};

const picture_of = (site: SiteCells, shades: Shades): HTMLCanvasElement | null => {
  const canvas = document.createElement('canvas');
  const context = canvas.getContext('2d');
  if (!context) return null;
  canvas.width = site.columns;
  canvas.height = site.rows;
  const image = context.createImageData(site.columns, site.rows);
  const pixels = new Uint32Array(image.data.buffer);
  site.cells.forEach((kind, k) => {
    pixels[k] = shade_of(kind, (k % site.columns) + Math.floor(k / site.columns), shades);
  });
  context.putImageData(image, 0, 0);
  return canvas;
};

/** The last picture: a map changes seldom, and is drawn at every frame. */
let kept: { cells: SiteCells; dark: boolean; picture: HTMLCanvasElement | null } | null = null;

const kept_picture = (cells: SiteCells): HTMLCanvasElement | null => {
  const night = is_dark();
  if (kept?.cells !== cells || kept.dark !== night) {
    kept = { cells, dark: night, picture: picture_of(cells, night ? dark : light) };
  }
  return kept.picture;
};

/**
 * M: the map, x along its axis. P: the picture, its first row at the top, its lower left corner at
 * the origin, turned by the origin's yaw. Pixels of P go to the screen by X_EM · X_MP.
 */
export const paint_site = (paint: Paint, { map, cells, at }: SiteOnMap): void => {
  const picture = kept_picture(cells);
  if (!picture) return;
  const { context, resolution } = paint;
  const [x, y] = to_plane(at);
  const units = units_per_m(at.lat);
  const [east_px, north_px] = [units.east / resolution, units.north / resolution];
  // Turns from east, left positive: of the map's x axis, and of the picture's.
  const map_turn = (90 - at.heading_deg) * RAD;
  const turn = map_turn + map.origin.yaw_deg * RAD;
  const [sin_m, cos_m] = [Math.sin(map_turn), Math.cos(map_turn)];
  const [sin, cos] = [Math.sin(turn), Math.cos(turn)];
  const cell_m = map.resolution_m * cells.thinned;
  const high_m = cells.rows * cell_m;
  const { x_m, y_m } = map.origin;
  const east_m = x_m * cos_m - y_m * sin_m - high_m * sin;
  const north_m = x_m * sin_m + y_m * cos_m + high_m * cos;
  // Cells larger than a pixel have sharp edges; of smaller ones no wall may fall between two pixels.
  context.imageSmoothingEnabled = cell_m * east_px < 1;
  context.imageSmoothingQuality = 'high';
  context.transform(
    cos * cell_m * east_px,
    -sin * cell_m * north_px,
    sin * cell_m * east_px,
    cos * cell_m * north_px,
    paint.x_px(x) + east_m * east_px,
    paint.y_px(y) - north_m * north_px,
  );
  context.drawImage(picture, 0, 0);
};

const STRIPE_PX = 10;

/** Stripes within the path that was traced. */
const hatch = ({ context, width_px, height_px }: Paint, color: string, lean: 1 | -1): void => {
  context.save();
  context.clip();
  context.beginPath();
  for (let at = -height_px; at < width_px + height_px; at += STRIPE_PX) {
    context.moveTo(at, 0);
    context.lineTo(at + lean * height_px, height_px);
  }
  context.strokeStyle = color;
  context.lineWidth = 2;
  context.stroke();
  context.restore();
};

const trace_ring = (paint: Paint, ring: readonly LatLon[]): void => {
  const { context } = paint;
  context.beginPath();
  ring.forEach((corner, k) => {
    const [x, y] = to_plane(corner);
    if (k === 0) context.moveTo(paint.x_px(x), paint.y_px(y));
    else context.lineTo(paint.x_px(x), paint.y_px(y));
  });
  context.closePath();
};

const edit_color = (kind: EditKind, colors: Palette): string =>
  kind === 'erase' ? colors.plan : kind === 'forbid' ? colors.refused : colors.robot;

/** Erased is light with a rim, forbidden is striped, a wall is full. */
export const paint_site_edits = (
  paint: Paint,
  edits: readonly SiteEdit[],
  colors: Palette,
): void => {
  const { context } = paint;
  for (const { kind, ring } of edits) {
    if (ring.length < 2) continue;
    const color = edit_color(kind, colors);
    trace_ring(paint, ring);
    if (kind === 'erase') {
      context.fillStyle = colors.casing;
      context.fill();
    } else if (kind === 'wall') {
      context.globalAlpha = 0.75;
      context.fillStyle = color;
      context.fill();
      context.globalAlpha = 1;
    } else {
      context.fillStyle = colors.keep_out;
      context.fill();
      hatch(paint, color, 1);
    }
    trace_ring(paint, ring);
    context.setLineDash(kind === 'erase' ? [6, 5] : []);
    stroke_cased(context, colors.casing, color, 2.5);
    context.setLineDash([]);
  }
};
