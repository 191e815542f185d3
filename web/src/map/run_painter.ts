// Draws runs of the past: what was planned as a broken line, what was driven above it, the second
// run in another colour.

import type { RunOnMap } from '../model/ports';
import { stroke_cased, trace, type Paint } from './canvas';
import type { Palette } from './palette';
import { to_plane_line, type PlaneLine } from './projection';

/** A run, projected once. */
export interface DrawnRun {
  readonly lines: readonly PlaneLine[];
  readonly planned: PlaneLine;
}

export const prepare_run = (run: RunOnMap): DrawnRun => ({
  lines: run.lines.map(to_plane_line),
  planned: to_plane_line(run.planned),
});

export const paint_runs = (paint: Paint, runs: readonly DrawnRun[], colors: Palette): void => {
  const { context } = paint;
  for (const { planned } of runs) {
    context.beginPath();
    trace(paint, planned.xs, planned.ys);
    context.setLineDash([8, 6]);
    context.strokeStyle = colors.run_plan;
    context.lineWidth = 2;
    context.stroke();
    context.setLineDash([]);
  }
  runs.forEach(({ lines }, k) => {
    context.beginPath();
    for (const { xs, ys } of lines) trace(paint, xs, ys);
    stroke_cased(context, colors.casing, k === 0 ? colors.run_a : colors.run_b, 3);
  });
};
