// The scene on the canvases, with the grid's labels and the scale bar beside it.

import type Layer from 'ol/layer/Layer';

import { canvas_layer } from './layers';
import { GridLabels } from './grid_labels';
import { palette } from './palette';
import { from_plane, units_per_m } from './projection';
import type { ScaleBar } from './scale_bar';
import type { Scene } from './scene';

export const layer_of = (scene: Scene, bar: ScaleBar): Layer => {
  const labels = new GridLabels();
  return canvas_layer({
    still: scene.still(),
    ground: (view) => scene.ground(view),
    target: (view) => scene.target(view),
    moving: (view) => scene.moving(view),
    above: (view) => scene.above(view),
    beside: (view, again) => {
      const here = from_plane(view.center);
      bar.show(view.resolution / units_per_m(here.lat).east);
      if (again) labels.write(view, scene.grid_origin(here), palette());
      labels.show(view, scene.cover);
      return labels.elements;
    },
  });
};
