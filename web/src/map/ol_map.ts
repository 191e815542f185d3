// The map of the library, without anything that is not asked for.

import OlMap from 'ol/Map';
import type View from 'ol/View';
import { defaults as default_interactions } from 'ol/interaction/defaults';

export const make_ol_map = (target: HTMLElement, view: View): OlMap =>
  new OlMap({
    target,
    view,
    controls: [],
    // The others of the browser's connections are for commands, and two for a stop.
    maxTilesLoading: 1,
    interactions: default_interactions({
      altShiftDragRotate: false,
      pinchRotate: false,
      doubleClickZoom: false,
      keyboard: false,
    }),
    moveTolerance: 4,
  });
