// Draws the places that are kept for good: where the ground gave way, and what the robot knows itself by.
// The graph along which ways are planned is drawn with the maps on which it lies (site_painter).

import type { KeptPlaces } from '../model/known_places';
import type { GraphOnMap } from '../model/node_graph';
import type { Paint } from './canvas';
import { paint_known, prepare_known, type DrawnKnown } from './known_painter';
import type { Palette } from './palette';
import { paint_slips, prepare_slips, type DrawnSlip } from './slip_painter';

export interface DrawnKept {
  readonly slips: readonly DrawnSlip[];
  readonly known: readonly DrawnKnown[];
  readonly graph: GraphOnMap | null;
}

export const prepare_kept = ({ slips, known, graph }: KeptPlaces): DrawnKept => ({
  slips: prepare_slips(slips),
  known: prepare_known(known),
  graph,
});

export const paint_kept = (paint: Paint, { slips, known }: DrawnKept, colors: Palette): void => {
  if (slips.length > 0) paint_slips(paint, slips, colors);
  if (known.length > 0) paint_known(paint, known, colors);
};
