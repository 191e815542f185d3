// A plan while one of its points is dragged: what stays where it is, drawn once, and the point with the
// two ways at it, drawn with every move of the finger.

import { band_of } from './band';
import { box_of } from './boxes';
import type { Box, Pixels } from './canvas';
import type { Drag } from './edit';
import { part_of, with_inserted, with_point, type DrawnPlan } from './plan_painter';
import { from_plane, type PlanePoint } from './projection';

const moved_spot = (drawn: DrawnPlan, { k, to }: Drag): DrawnPlan => {
  const first = Math.max(0, k - 1);
  const part = part_of(drawn, first, k + 2);
  const line = with_point(part.line, k - first, to);
  return { ...part, line, band: band_of(line, part.rings) };
};

/** Its neighbours, and a new one between them. */
const new_spot = (drawn: DrawnPlan, { k, to }: Drag): DrawnPlan => {
  const part = part_of(drawn, k - 1, k + 1);
  const line = with_inserted(part.line, 1, to);
  const [before, after] = part.spots;
  const spots = before && after ? [before, { ...from_plane(to), index: after.index }] : [];
  const rings = part.rings.map((ring) => (ring.k === 1 ? { ...ring, k: 2 } : ring));
  return { spots, chips: [0, 0], line, rings, backwards: [], band: band_of(line, rings) };
};

/** Without the point. */
export const rest_of = (drawn: DrawnPlan, drag: Drag): readonly DrawnPlan[] => {
  const after = drag.what === 'spot' ? drag.k + 1 : drag.k;
  return [part_of(drawn, 0, drag.k), part_of(drawn, after, drawn.spots.length)];
};

export const moved_of = (drawn: DrawnPlan, drag: Drag): DrawnPlan =>
  drag.what === 'spot' ? moved_spot(drawn, drag) : new_spot(drawn, drag);

/** Around points: with their numbers, and the figures of ways and turns. */
const POINT_PX = 70;

/** What of the screen a plan takes. */
export const plan_box = ({ band, rings }: DrawnPlan, pixels: Pixels): Box | null => {
  const { xs, ys } = band.line;
  const rings_px = rings.map((ring) => (ring.radius_m * ring.units_per_m) / pixels.resolution);
  const places = Array.from(xs, (x, k): PlanePoint => [x, ys[k] ?? 0]);
  return box_of(pixels, places, POINT_PX + Math.max(0, ...rings_px));
};
