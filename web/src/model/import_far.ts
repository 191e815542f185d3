// A file that leads to another country: mostly of another farm, or with latitude and longitude exchanged.

import { metres } from './format';
import { distance_m } from './geo';
import type { LatLon } from './plan';
import { say } from './say';

const FAR_M = 10_000;

/** @param at the first place of the file; undefined: it tells none
 * @param robot null: nobody knows where it is
 * @return null: it is near, or nothing can be said */
export const far_words = (at: LatLon | undefined, robot: LatLon | null): string | null => {
  if (!at || !robot) return null;
  const far_m = distance_m(robot, at);
  if (!(far_m > FAR_M)) return null;
  const words = say('import_far_away', { far: metres(far_m) });
  const exchanged_m =
    Math.abs(at.lon) <= 90 ? distance_m(robot, { lat: at.lon, lon: at.lat }) : Infinity;
  return exchanged_m < far_m / 10
    ? `${words} ${say('import_exchanged', { near: metres(exchanged_m) })}`
    : words;
};
