// Draws runs of the past: what was planned as a broken line, what was driven above it, in a colour of
// the run or by shades, and where each was at the moment that is looked at. Several runs as squares.

import type { Heat } from '../model/heat';
import type { LatLon } from '../model/plan';
import type { RunOnMap } from '../model/run_ports';
import { HEAT_LIMITS_M, shade_of, type Moment, type Shades } from '../model/run_track';
import { stroke_cased, trace, type Paint } from './canvas';
import type { Palette } from './palette';
import {
  to_plane,
  to_plane_line,
  units_per_m,
  type PlaneLine,
  type PlanePoint,
} from './projection';
import type { Size } from './robot_painter';

export interface DrawnRun {
  readonly lines: readonly PlaneLine[];
  readonly planned: PlaneLine;
  readonly shades: Shades | null;
  readonly at: Moment | null;
}

/** Lines are projected once: at another moment they are the same. */
const projected = new WeakMap<object, readonly PlaneLine[]>();
const lines_in_plane = (lines: readonly (readonly LatLon[])[]): readonly PlaneLine[] => {
  const known = projected.get(lines);
  if (known) return known;
  const made = lines.map(to_plane_line);
  projected.set(lines, made);
  return made;
};

export const prepare_run = (run: RunOnMap): DrawnRun => ({
  lines: lines_in_plane(run.lines),
  planned: to_plane_line(run.planned),
  shades: run.shades ?? null,
  at: run.at ?? null,
});

const LINE_PX = 3;

/** The casing once below all, then the pieces of each shade in one path. */
const stroke_shaded = (paint: Paint, run: DrawnRun, shades: Shades, colors: Palette): void => {
  const { context } = paint;
  context.beginPath();
  for (const { xs, ys } of run.lines) trace(paint, xs, ys);
  stroke_cased(context, colors.casing, colors.run_plan, LINE_PX);
  context.lineWidth = LINE_PX + 1;
  for (let shade = 0; shade <= shades.limits.length; shade += 1) {
    context.beginPath();
    run.lines.forEach(({ xs, ys }, line) => {
      const of = shades.of[line] ?? new Uint8Array();
      for (let k = 0; k < of.length; k += 1) {
        if (of[k] !== shade) continue;
        let end = k;
        while (end < of.length && of[end] === shade) end += 1;
        // To the next piece, so that no gap is left between two shades.
        trace(paint, xs, ys, k, Math.min(end + 1, xs.length));
        k = end;
      }
    });
    context.strokeStyle = colors.shades[shade] ?? colors.run_plan;
    context.stroke();
  }
};

const NOSE_PX = 14;

/** An arrow of the run's colour, in the vehicle's size where that is larger. */
const paint_moment = (
  paint: Paint,
  at: Moment,
  size: Size,
  color: string,
  casing: string,
): void => {
  const { context, x_px, y_px, resolution } = paint;
  const [x, y] = to_plane(at);
  const nose_px = Math.max(NOSE_PX, (size.length_m * units_per_m(at.lat).east) / resolution / 2);
  context.save();
  context.translate(x_px(x), y_px(y));
  context.beginPath();
  if (at.heading_deg === null) {
    context.arc(0, 0, NOSE_PX / 2, 0, 2 * Math.PI);
  } else {
    context.rotate((at.heading_deg * Math.PI) / 180);
    context.moveTo(0, -nose_px);
    context.lineTo(0.7 * nose_px, 0.8 * nose_px);
    context.lineTo(0, 0.45 * nose_px);
    context.lineTo(-0.7 * nose_px, 0.8 * nose_px);
    context.closePath();
  }
  context.lineWidth = 4;
  context.strokeStyle = casing;
  context.stroke();
  context.fillStyle = color;
  context.fill();
  context.restore();
};

export const paint_runs = (
  paint: Paint,
  runs: readonly DrawnRun[],
  size: Size,
  colors: Palette,
): void => {
  const { context } = paint;
  const color_of = (k: number): string => (k === 0 ? colors.run_a : colors.run_b);
  for (const { planned } of runs) {
    context.beginPath();
    trace(paint, planned.xs, planned.ys);
    context.setLineDash([8, 6]);
    context.strokeStyle = colors.run_plan;
    context.lineWidth = 2;
    context.stroke();
    context.setLineDash([]);
  }
  runs.forEach((run, k) => {
    if (run.shades) return stroke_shaded(paint, run, run.shades, colors);
    context.beginPath();
    for (const { xs, ys } of run.lines) trace(paint, xs, ys);
    // The second one dashed, so that both are seen where they lie on each other.
    context.setLineDash(k === 0 ? [] : [14, 10]);
    stroke_cased(context, k === 0 ? colors.casing : 'transparent', color_of(k), LINE_PX);
    context.setLineDash([]);
  });
  runs.forEach(({ at }, k) => {
    if (at) paint_moment(paint, at, size, color_of(k), colors.casing);
  });
};

export interface DrawnHeat {
  /** Side of a square in the plane. */
  readonly side: number;
  readonly cells: readonly {
    readonly at: PlanePoint;
    readonly shade: number;
    readonly share: number;
  }[];
}

export const prepare_heat = ({ cell_m, cells }: Heat): DrawnHeat => {
  const most = cells.reduce((largest, { runs }) => Math.max(largest, runs), 1);
  return {
    side: cell_m * units_per_m(cells[0]?.lat ?? 0).east,
    cells: cells.map((cell) => ({
      at: to_plane(cell),
      shade: shade_of(cell.off_m ?? Number.NaN, HEAT_LIMITS_M),
      share: cell.runs / most,
    })),
  };
};

/** The colour says how far off the path, the strength how many came there. */
export const paint_heat = (paint: Paint, heat: DrawnHeat, colors: Palette): void => {
  const { context, x_px, y_px, width_px, height_px } = paint;
  const side_px = Math.max(2, heat.side / paint.resolution + 0.5);
  for (const { at, shade, share } of heat.cells) {
    const x = x_px(at[0]) - side_px / 2;
    const y = y_px(at[1]) - side_px / 2;
    if (x < -side_px || y < -side_px || x > width_px || y > height_px) continue;
    context.globalAlpha = 0.3 + 0.65 * share;
    context.fillStyle = colors.shades[shade] ?? colors.run_plan;
    context.fillRect(x, y, side_px, side_px);
  }
  context.globalAlpha = 1;
};
