// Lines beside the edited mission, to compare it with.

import type { BesideTone, LineOnMap } from './on_map';
import { spots, type Plan } from './plan';

/** The way through a plan's places; none: it has none. */
export const line_of = (plan: Plan, tone: BesideTone): readonly LineOnMap[] => {
  const places = spots(plan);
  return places.length === 0 ? [] : [{ places, tone }];
};
