// Draws the places that are kept for good: the graph along which ways are planned, where the ground gave
// way, and what the robot knows itself by.

import type { KeptPlaces } from '../model/known_places';
import type { Paint } from './canvas';
import { paint_graph, prepare_graph, type DrawnGraph } from './graph_painter';
import { paint_known, prepare_known, type DrawnKnown } from './known_painter';
import type { Palette } from './palette';
import { paint_slips, prepare_slips, type DrawnSlip } from './slip_painter';

export interface DrawnKept {
  readonly graph: DrawnGraph | null;
  readonly slips: readonly DrawnSlip[];
  readonly known: readonly DrawnKnown[];
}

export const prepare_kept = ({ graph, slips, known }: KeptPlaces): DrawnKept => ({
  graph: graph && prepare_graph(graph),
  slips: prepare_slips(slips),
  known: prepare_known(known),
});

export const paint_kept = (
  paint: Paint,
  { graph, slips, known }: DrawnKept,
  colors: Palette,
): void => {
  if (graph) paint_graph(paint, graph, colors);
  if (slips.length > 0) paint_slips(paint, slips, colors);
  if (known.length > 0) paint_known(paint, known, colors);
};
