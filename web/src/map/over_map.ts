// What stands over the map and can be pressed, besides the map's own buttons: STOP and the camera.

import type { Box } from './canvas';

/** @return pixels of the map; of a phone's stop button, too, which stands below it */
export const over_map = (target: HTMLElement): Box[] => {
  const { left, top } = target.getBoundingClientRect();
  return [...document.querySelectorAll('[data-stop], [data-over-map]')].map((each) => {
    const box = each.getBoundingClientRect();
    return {
      left: box.left - left,
      top: box.top - top,
      right: box.right - left,
      bottom: box.bottom - top,
    };
  });
};
