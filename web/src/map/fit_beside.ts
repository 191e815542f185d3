// Fits places beside what stands over the map. It comes with the first fit: the page does without.

import type View from 'ol/View';

import type { Box } from './canvas';
import type { Fitted, FreePart, Padding } from './sight';

/** @return STOP and the camera, pixels of the map; a phone's stop button stands below it */
const over_map = (target: HTMLElement): Box[] => {
  const { left, top } = target.getBoundingClientRect();
  return [...document.querySelectorAll('[data-stop], .camera')].map((each) => {
    const box = each.getBoundingClientRect();
    return {
      left: box.left - left,
      top: box.top - top,
      right: box.right - left,
      bottom: box.bottom - top,
    };
  });
};

/** Half of a waypoint's sign. */
const CLEAR_PX = 24;

/** The four ways to stay out of one. */
const beside = ([top, right, bottom, left]: Padding, box: Box, free: FreePart): Padding[] => [
  [Math.max(top, box.bottom + CLEAR_PX - free.top), right, bottom, left],
  [top, Math.max(right, free.left + free.width - box.left + CLEAR_PX), bottom, left],
  [top, right, Math.max(bottom, free.top + free.height - box.top + CLEAR_PX), left],
  [top, right, bottom, Math.max(left, box.right + CLEAR_PX - free.left)],
];

/**
 * Fits them anew if one of them lies where it cannot be tapped: as large as they can be beside it all.
 * @param over what stands over the map besides its own buttons, pixels of it
 */
export const fit_beside = (
  view: View,
  { fit, pixels, padding }: Fitted,
  free: FreePart,
  over: readonly Box[],
): void => {
  const covers = (box: Box, [x, y]: readonly [number, number]): boolean =>
    x > box.left - CLEAR_PX &&
    x < box.right + CLEAR_PX &&
    y > box.top - CLEAR_PX &&
    y < box.bottom + CLEAR_PX;
  const is_clear = (): boolean => !pixels().some((pixel) => over.some((box) => covers(box, pixel)));
  if (is_clear()) return;
  const [resolution, center] = [view.getResolution(), view.getCenter()];
  const parts = over.reduce<Padding[]>(
    (all, box) => all.flatMap((each) => [each, ...beside(each, box, free)]),
    [padding],
  );
  let best: Padding | null = null;
  let finest = Infinity;
  for (const part of parts) {
    const [top, right, bottom, left] = part;
    if (free.width - left - right < 1 || free.height - top - bottom < 1) continue;
    fit(part);
    const next = view.getResolution() ?? Infinity;
    if (next < finest && is_clear()) [best, finest] = [part, next];
  }
  if (best) {
    fit(best);
    return;
  }
  view.setResolution(resolution);
  view.setCenter(center);
};

/** The same beside what stands over the map now. @param target the map's */
export const keep_clear = (
  view: View,
  fitted: Fitted,
  free: FreePart,
  target: HTMLElement,
): void => {
  fit_beside(view, fitted, free, over_map(target));
};
