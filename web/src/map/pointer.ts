// Which place lies under a mouse. A finger hides what it points to: of fingers nothing is told.

import type OlMap from 'ol/Map';

import type { LatLon } from '../model/plan';
import { from_plane } from './projection';

/** @param moved hears of every move; null: the mouse has left the map */
export const watch_pointer = (
  map: OlMap,
  target: HTMLElement,
  moved: (at: LatLon | null) => void,
): void => {
  target.addEventListener('pointermove', (event) => {
    if (event.pointerType === 'mouse') moved(from_plane(map.getEventCoordinate(event)));
  });
  target.addEventListener('pointerleave', () => moved(null));
};
