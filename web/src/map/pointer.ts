// Which place lies under a mouse. A finger hides what it points to: of fingers nothing is told.

import type OlMap from 'ol/Map';

import type { LatLon } from '../model/plan';
import { from_plane } from './projection';

/** A mouse tells of more places than can be read, and each one written makes the page lay itself out. */
const SAY_MS = 80;

/** @param moved hears which place it is, a few times a second; null: the mouse has left the map */
export const watch_pointer = (
  map: OlMap,
  target: HTMLElement,
  moved: (at: LatLon | null) => void,
): void => {
  let last: PointerEvent | null = null;
  let timer: ReturnType<typeof setTimeout> | undefined;
  const say = (): void => {
    timer = undefined;
    if (last) moved(from_plane(map.getEventCoordinate(last)));
  };
  target.addEventListener('pointermove', (event) => {
    if (event.pointerType !== 'mouse') return;
    last = event;
    timer ??= setTimeout(say, SAY_MS);
  });
  target.addEventListener('pointerleave', () => {
    last = null;
    moved(null);
  });
};
