// The map's own ground: a grid in metres from an origin, so that a person can judge distances with
// no tiles and no internet. Where a plane grid makes no sense any more (more than 20 km across) it
// becomes a net of degrees.

import { round_step_above } from '../model/geo';
import type { LatLon } from '../model/plan';
import type { Paint } from './canvas';
import type { Palette } from './palette';
import { from_plane, to_plane, units_per_m } from './projection';

/** Labelled lines are at least this far apart. */
const MAJOR_PX = 96;
const METRIC_UP_TO_M = 20_000;
const FONT = '600 11px system-ui, sans-serif';

export interface Cover {
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
  readonly left: number;
}

interface Axis {
  /** Where line number n lies, pixels. */
  at(n: number): number;
  readonly from: number;
  readonly to: number;
  label(n: number): string;
}

const lines = (paint: Paint, axis: Axis, vertical: boolean): void => {
  const { context, width_px, height_px } = paint;
  context.beginPath();
  for (let n = Math.ceil(axis.from); n <= axis.to; n += 1) {
    const p = Math.round(axis.at(n)) + 0.5;
    context.moveTo(vertical ? p : 0, vertical ? 0 : p);
    context.lineTo(vertical ? p : width_px, vertical ? height_px : p);
  }
  context.stroke();
};

const labels = (paint: Paint, axis: Axis, vertical: boolean, cover: Cover): void => {
  const { context, width_px, height_px } = paint;
  for (let n = Math.ceil(axis.from); n <= axis.to; n += 1) {
    const p = axis.at(n);
    const x = vertical ? p + 4 : cover.left + 8;
    const y = vertical ? cover.top + 14 : p - 4;
    const hidden = vertical
      ? x < cover.left + 60 || x > width_px - cover.right - 110
      : y < cover.top + 30 || y > height_px - cover.bottom - 40;
    if (hidden) continue;
    context.strokeText(axis.label(n), x, y);
    context.fillText(axis.label(n), x, y);
  }
};

/** "40 m E": a bare number has no direction. */
const metre_label = (value: number, plus: string, minus: string): string => {
  if (value === 0) return '0';
  const size = Math.abs(value);
  const text = size >= 1000 ? `${size / 1000} km` : `${Number(size.toPrecision(6))} m`;
  return `${text} ${value > 0 ? plus : minus}`;
};

const metric_axes = (paint: Paint, origin: LatLon, step_m: number): [Axis, Axis] => {
  const [x0, y0] = to_plane(origin);
  const units = units_per_m(origin.lat);
  const reach_x = (paint.width_px / 2) * paint.resolution;
  const reach_y = (paint.height_px / 2) * paint.resolution;
  const [cx, cy] = paint.center;
  // The padding of the view moves its centre on the screen: take in a whole screen more.
  const east = (x: number): number => (x - x0) / units.east / step_m;
  const north = (y: number): number => (y - y0) / units.north / step_m;
  return [
    {
      at: (n) => paint.x_px(x0 + n * step_m * units.east),
      from: east(cx - 2 * reach_x),
      to: east(cx + 2 * reach_x),
      label: (n) => metre_label(n * step_m, 'E', 'W'),
    },
    {
      at: (n) => paint.y_px(y0 + n * step_m * units.north),
      from: north(cy - 2 * reach_y),
      to: north(cy + 2 * reach_y),
      label: (n) => metre_label(n * step_m, 'N', 'S'),
    },
  ];
};

const degree_axes = (paint: Paint, step_deg: number): [Axis, Axis] => {
  const reach_x = paint.width_px * paint.resolution;
  const reach_y = paint.height_px * paint.resolution;
  const [cx, cy] = paint.center;
  const low = from_plane([cx - reach_x, cy - reach_y]);
  const high = from_plane([cx + reach_x, cy + reach_y]);
  const text = (value: number, plus: string, minus: string): string =>
    `${Number(Math.abs(value).toPrecision(6))}° ${value < 0 ? minus : value > 0 ? plus : ''}`.trim();
  return [
    {
      at: (n) => paint.x_px(to_plane({ lat: 0, lon: n * step_deg })[0]),
      from: Math.max(low.lon > high.lon ? -180 : low.lon, -180) / step_deg,
      to: Math.min(low.lon > high.lon ? 180 : high.lon, 180) / step_deg,
      label: (n) => text(n * step_deg, 'E', 'W'),
    },
    {
      at: (n) => paint.y_px(to_plane({ lat: n * step_deg, lon: 0 })[1]),
      from: Math.max(low.lat, -85) / step_deg,
      to: Math.min(high.lat, 85) / step_deg,
      label: (n) => text(n * step_deg, 'N', 'S'),
    },
  ];
};

export const paint_grid = (paint: Paint, colors: Palette, origin: LatLon, cover: Cover): void => {
  const { context, resolution } = paint;
  const here = from_plane(paint.center);
  const pixel_m = resolution / units_per_m(here.lat).east;
  const metric = pixel_m * Math.max(paint.width_px, paint.height_px) <= METRIC_UP_TO_M;
  const [, deg_resolution] = to_plane({ lat: 1, lon: 1 });
  const step = metric
    ? round_step_above(MAJOR_PX * pixel_m)
    : Math.min(round_step_above((MAJOR_PX * resolution) / deg_resolution), 50);
  const axes = (size: number): [Axis, Axis] =>
    metric ? metric_axes(paint, origin, size) : degree_axes(paint, size);

  context.lineWidth = 1;
  context.strokeStyle = colors.grid_minor;
  axes(step / 5).forEach((axis, k) => lines(paint, axis, k === 0));
  context.strokeStyle = colors.grid_major;
  axes(step).forEach((axis, k) => lines(paint, axis, k === 0));

  context.font = FONT;
  context.textAlign = 'left';
  context.fillStyle = colors.grid_label;
  context.strokeStyle = colors.ground;
  context.lineWidth = 3;
  context.lineJoin = 'round';
  axes(step).forEach((axis, k) => labels(paint, axis, k === 0, cover));
};
