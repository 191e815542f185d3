// Joins the hand on the map with what is shown: what it can take, what a dragged point is caught by,
// and the glass beside a finger.

import type OlMap from 'ol/Map';

import { area_places } from '../model/fence';
import { EditInteraction } from './edit';
import { Loupe } from './loupe';
import { to_plane, to_plane_line, type PlanePoint } from './projection';
import type { Scene } from './scene';
import { snapped, type SnapLine } from './snap';

const points = (...places: readonly PlanePoint[]): SnapLine => ({
  xs: Float64Array.from(places, ([x]) => x),
  ys: Float64Array.from(places, ([, y]) => y),
  closed: false,
});

/** The edited line first. */
const snap_lines = (scene: Scene): SnapLine[] => {
  const areas = scene.fence?.areas ?? [];
  const fixed = [scene.home, scene.robot?.at].flatMap((at) => (at ? [to_plane(at)] : []));
  return [
    { ...scene.plan.drawn.line, closed: false },
    { ...scene.route.drawn.line, closed: false },
    // Each is a line of its own: nothing joins home and the robot.
    ...fixed.map((at) => points(at)),
    ...scene.beside
      .filter(({ tone, points: apart }) => tone === 'other' && !apart)
      .map(({ line }) => ({ ...line, closed: false })),
    ...areas
      .filter(({ polygon }) => polygon)
      .map((area) => ({ ...to_plane_line(area_places(area)), closed: true })),
  ];
};

/** @param target the element with the map */
export const make_hand = (scene: Scene, map: OlMap, target: HTMLElement): EditInteraction => {
  const loupe = new Loupe(target);
  map.on('postrender', () => loupe.draw());
  /** Nothing that lies there changes while a point is dragged. */
  let lines: readonly SnapLine[] | null = null;
  return new EditInteraction({
    drawn: () => scene.plan.drawn,
    events: () => scene.events,
    resolution: () => map.getView().getResolution() ?? 1,
    joined: () => scene.look.shape !== 'points',
    is_chosen: (index) => index === scene.look.selected || scene.picked.has(index),
    snap: (to, skip, reach) => {
      if (!scene.snaps) return { to, held: false };
      lines ??= snap_lines(scene);
      return snapped(lines, to, reach, skip);
    },
    show: (drag, finger) => {
      scene.drag = drag;
      if (drag === null) lines = null;
      loupe.point(finger);
      map.render();
    },
    show_box: (box) => {
      scene.box = box;
      map.render();
    },
  });
};
