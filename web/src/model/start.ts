// Where a start begins, in words.

import { count, metres } from './format';
import type { Preview, SmoothedItems, Vehicle } from './vehicle';

/** Empty: it drives to its first item, which is said anyway. */
export const beginning_words = (preview: Preview): string => {
  const { joins_after_m, left_out } = preview;
  if (joins_after_m === null) return '';
  const where =
    joins_after_m < 0.05
      ? 'The robot stands at the beginning of its way and goes on from there.'
      : `The robot joins its way where it stands, ${metres(joins_after_m)} after its beginning.`;
  if (left_out === 0) return where;
  return `${where} ${count(left_out, 'item')} before it ${left_out === 1 ? 'is' : 'are'} left out; choose an item to begin there.`;
};

/** What is asked of the driving while the position is as certain as it is; empty: nothing is driven. */
export const tolerance_words = (mission: Vehicle['mission']): string => {
  const { arrival_radius_m, cross_track_limit_m } = mission;
  if (arrival_radius_m === null || cross_track_limit_m === null) return '';
  return `Counts as reached within ${metres(arrival_radius_m)}; pauses ${metres(cross_track_limit_m)} off its way.`;
};

/** How far the way is from its items. @param stretches the farthest first. Empty: it meets them. */
export const smoothed_words = (stretches: readonly SmoothedItems[]): string => {
  const [farthest] = stretches;
  if (!farthest) return '';
  const where =
    stretches.length === 1
      ? `Items ${farthest.first_item} to ${farthest.last_item} are`
      : `${stretches.length} stretches of dense points are`;
  return `${where} driven as a smooth way, at most ${metres(farthest.deviation_m)} beside them.`;
};
