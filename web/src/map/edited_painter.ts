// Draws the plan that is edited: what of it stays, and what the finger moves.

import { band_of, ring_behind, type Band } from './band';
import { box_of, whole } from './boxes';
import { pixels_of, type Mover, type Paint, type View } from './canvas';
import { moved_of, plan_box, rest_of } from './dragging';
import type { Box, Drag } from './edit';
import { leg_labels, paint_labels } from './leg_labels';
import {
  paint_beside,
  paint_box,
  paint_caught,
  paint_picked,
  type DrawnBeside,
} from './pick_painter';
import {
  paint_plan,
  with_inserted,
  with_moved,
  with_point,
  type DrawnPlan,
  type PlanLook,
} from './plan_painter';
import type { PlaneLine } from './projection';

export interface Edited {
  readonly plan: { readonly drawn: DrawnPlan };
  readonly look: PlanLook;
  readonly drag: Drag | null;
  /** The box that chooses points. */
  readonly box: Box | null;
  readonly picked: ReadonlySet<number>;
  readonly beside: readonly DrawnBeside[];
}

const FAINT = 0.4;

/** Numbers of the spots that are chosen. */
const picked_spots = ({ plan, picked }: Edited): number[] =>
  picked.size === 0
    ? []
    : plan.drawn.spots.flatMap(({ index }, k) => (picked.has(index) ? [k] : []));

/** All of it is drawn with every move: an area, or several points that are dragged together. */
const moves_whole = (edited: Edited): boolean => {
  const { drag, look, plan, picked } = edited;
  if (!drag) return false;
  const taken = plan.drawn.spots[drag.k]?.index ?? -1;
  return look.shape === 'ring' || (drag.what !== 'handle' && picked.has(taken));
};

const paint_figures = (paint: Paint, look: PlanLook, band: Band, near: readonly number[]): void => {
  if (!look.handles || look.shape === 'points') return;
  paint_labels(paint, leg_labels(paint, band, new Set(near)));
};

/** Without what is dragged. */
export const paint_edited = (paint: Paint, edited: Edited): void => {
  const { look, drag, plan } = edited;
  const { drawn } = plan;
  paint_beside(paint, edited.beside);
  if (moves_whole(edited)) return;
  if (look.faint) paint.context.globalAlpha = FAINT;
  const selected = drawn.spots.findIndex(({ index }) => index === look.selected);
  for (const part of drag ? rest_of(drawn, drag) : [drawn]) {
    paint_plan(paint, part, part.line, part.rings, look);
    paint_figures(paint, look, part.band, drag ? [] : [selected]);
  }
  paint_picked(paint, drawn.line, picked_spots(edited));
};

/** One point, and the two ways at it. */
const mover_of_one = (view: View, edited: Edited, drag: Drag): Mover => {
  const { look, plan } = edited;
  const moved = moved_of(plan.drawn, drag);
  return {
    box: plan_box(moved, pixels_of(view, 0)),
    paint: (paint) => {
      paint_plan(paint, moved, moved.line, moved.rings, { ...look, handles: false });
      paint_figures(paint, look, moved.band, [Math.min(1, drag.k)]);
      if (drag.held) paint_caught(paint, drag.to);
    },
  };
};

const line_of_all = ({ plan }: Edited, drag: Drag, ks: readonly number[]): PlaneLine => {
  const { line } = plan.drawn;
  if (drag.what === 'handle') return with_inserted(line, drag.k, drag.to);
  return ks.includes(drag.k) ? with_moved(line, ks, drag) : with_point(line, drag.k, drag.to);
};

const mover_of_all = (view: View, edited: Edited, drag: Drag): Mover => {
  const { drawn } = edited.plan;
  const ks = picked_spots(edited);
  const line = line_of_all(edited, drag, ks);
  const rings =
    drag.what === 'handle' ? drawn.rings.map((ring) => ring_behind(ring, drag.k)) : drawn.rings;
  return {
    box: whole(view),
    paint: (paint) => {
      paint_plan(paint, drawn, line, rings, edited.look);
      paint_picked(paint, line, ks);
      paint_figures(paint, edited.look, band_of(line, rings), [drag.k]);
      if (drag.held) paint_caught(paint, drag.to);
    },
  };
};

/** In the middle of a drag the line already goes where it will go. */
export const edited_movers = (view: View, edited: Edited): readonly Mover[] => {
  const { box, drag } = edited;
  const movers: Mover[] = [];
  if (drag && moves_whole(edited)) movers.push(mover_of_all(view, edited, drag));
  else if (drag) movers.push(mover_of_one(view, edited, drag));
  if (box) {
    movers.push({
      box: box_of(pixels_of(view, 0), box, 4),
      paint: (paint) => paint_box(paint, box),
    });
  }
  return movers;
};
