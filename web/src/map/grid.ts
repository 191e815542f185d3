// The map's own ground: a grid in metres from an origin, so that a person can judge distances with
// no tiles and no internet. Where a plane grid makes no sense any more (more than 20 km across) it
// becomes a net of degrees.

import { shortest } from '../model/figures';
import { wind } from '../model/format';
import { round_step_above } from '../model/geo';
import type { LatLon } from '../model/plan';
import { pixels_of, type Paint, type Pixels, type View } from './canvas';
import type { Palette } from './palette';
import { from_plane, to_plane, units_per_m } from './projection';

/** Labelled lines are at least this far apart. */
const MAJOR_PX = 96;
const METRIC_UP_TO_M = 20_000;

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

/** "40 m E": a bare number has no direction. */
const metre_label = (value: number, plus: string, minus: string): string => {
  if (value === 0) return '0';
  const size = Math.abs(value);
  const text = size >= 1000 ? `${shortest(size / 1000, 3)} km` : `${shortest(size, 2)} m`;
  return `${text} ${value > 0 ? plus : minus}`;
};

const metric_axes = (paint: Pixels, origin: LatLon, step_m: number): [Axis, Axis] => {
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
      label: (n) => metre_label(n * step_m, wind('east'), wind('west')),
    },
    {
      at: (n) => paint.y_px(y0 + n * step_m * units.north),
      from: north(cy - 2 * reach_y),
      to: north(cy + 2 * reach_y),
      label: (n) => metre_label(n * step_m, wind('north'), wind('south')),
    },
  ];
};

const degree_axes = (paint: Pixels, step_deg: number): [Axis, Axis] => {
  const reach_x = paint.width_px * paint.resolution;
  const reach_y = paint.height_px * paint.resolution;
  const [cx, cy] = paint.center;
  const low = from_plane([cx - reach_x, cy - reach_y]);
  const high = from_plane([cx + reach_x, cy + reach_y]);
  const text = (value: number, plus: string, minus: string): string =>
    `${shortest(Math.abs(value), 4)}° ${value < 0 ? minus : value > 0 ? plus : ''}`.trim();
  return [
    {
      at: (n) => paint.x_px(to_plane({ lat: 0, lon: n * step_deg })[0]),
      from: Math.max(low.lon > high.lon ? -180 : low.lon, -180) / step_deg,
      to: Math.min(low.lon > high.lon ? 180 : high.lon, 180) / step_deg,
      label: (n) => text(n * step_deg, wind('east'), wind('west')),
    },
    {
      at: (n) => paint.y_px(to_plane({ lat: n * step_deg, lon: 0 })[1]),
      from: Math.max(low.lat, -85) / step_deg,
      to: Math.min(high.lat, 85) / step_deg,
      label: (n) => text(n * step_deg, wind('north'), wind('south')),
    },
  ];
};

/** The axes with labelled lines, or with all of them. */
const axes_of = (paint: Pixels, origin: LatLon, share: number): [Axis, Axis] => {
  const { resolution } = paint;
  const here = from_plane(paint.center);
  const pixel_m = resolution / units_per_m(here.lat).east;
  const metric = pixel_m * Math.max(paint.width_px, paint.height_px) <= METRIC_UP_TO_M;
  const [, deg_resolution] = to_plane({ lat: 1, lon: 1 });
  const step = metric
    ? round_step_above(MAJOR_PX * pixel_m)
    : Math.min(round_step_above((MAJOR_PX * resolution) / deg_resolution), 50);
  return metric ? metric_axes(paint, origin, step * share) : degree_axes(paint, step * share);
};

export const paint_grid = (paint: Paint, colors: Palette, origin: LatLon): void => {
  const { context } = paint;
  context.lineWidth = 1;
  context.strokeStyle = colors.grid_minor;
  axes_of(paint, origin, 0.2).forEach((axis, k) => lines(paint, axis, k === 0));
  context.strokeStyle = colors.grid_major;
  axes_of(paint, origin, 1).forEach((axis, k) => lines(paint, axis, k === 0));
};

/** A word beside a line of the grid. */
export interface GridLabel {
  readonly text: string;
  /** Where the line is, pixels from the left or from above. */
  readonly at_px: number;
}

/** @param beyond_px of the screen, on each side @return of lines that go up, and that go across */
export const labels_of = (
  view: View,
  origin: LatLon,
  beyond_px: number,
): readonly [readonly GridLabel[], readonly GridLabel[]] => {
  const paint = pixels_of(view, 0);
  const along = (axis: Axis, length_px: number): GridLabel[] => {
    const found: GridLabel[] = [];
    for (let n = Math.ceil(axis.from); n <= axis.to; n += 1) {
      const at_px = axis.at(n);
      if (at_px < -beyond_px || at_px > length_px + beyond_px) continue;
      found.push({ text: axis.label(n), at_px });
    }
    return found;
  };
  const [columns, rows] = axes_of(paint, origin, 1);
  return [along(columns, view.width_px), along(rows, view.height_px)];
};
