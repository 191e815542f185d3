// The map: tiles if there are any, and above them one canvas with grid, route, trail, mission and
// robot. It keeps what it was told to show and draws it in the next animation frame.

import OlMap from 'ol/Map';
import View from 'ol/View';
import { defaults as default_interactions } from 'ol/interaction/defaults';
import TileLayer from 'ol/layer/Tile';
import XYZ from 'ol/source/XYZ';

import { distance_m } from '../model/geo';
import { EMPTY_PLAN, type LatLon, type Plan } from '../model/plan';
import type { MapCalls, MapEvents, RobotOnMap, TileSet } from '../model/ports';
import { canvas_layer, type Paint, type Painter } from './canvas';
import { EditInteraction, type Drag } from './edit';
import { paint_grid, type Cover } from './grid';
import { on_palette_change, palette } from './palette';
import {
  paint_plan,
  paint_route,
  prepare_plan,
  with_inserted,
  with_point,
  type DrawnPlan,
  type PlanLook,
} from './plan_painter';
import { from_plane, to_plane, units_per_m } from './projection';
import { paint_home, paint_robot, TrailLine, type Size } from './robot_painter';
import { make_scale_bar, type ScaleBar } from './scale_bar';

/** Until something is known: the whole world, in degrees. */
const WORLD_ZOOM = 2;
/** About a hundred metres across a laptop screen at middle latitudes. */
const WORK_ZOOM = 20;
/** Beyond this from its origin the grid gets a new one. */
const GRID_REACH_M = 10_000;

const NO_EVENTS: MapEvents = {
  on_add: () => undefined,
  on_insert: () => undefined,
  on_move: () => undefined,
  on_select: () => undefined,
  on_pan: () => undefined,
};

interface Shown {
  events: MapEvents;
  plan_source: Plan;
  plan: DrawnPlan;
  look: PlanLook;
  drag: Drag | null;
  route_source: Plan | null;
  route: DrawnPlan | null;
  current_item: number;
  size: Size;
  robot: RobotOnMap | null;
  home: LatLon | null;
  cover: Cover;
  origin: LatLon | null;
  follow: boolean;
  editing: boolean;
  placed: boolean;
}

const nothing_shown = (): Shown => ({
  events: NO_EVENTS,
  plan_source: EMPTY_PLAN,
  plan: prepare_plan(EMPTY_PLAN),
  look: { selected: null, refused: new Set(), handles: false },
  drag: null,
  route_source: null,
  route: null,
  current_item: 0,
  size: { length_m: 1.023, width_m: 0.778 },
  robot: null,
  home: null,
  cover: { top: 0, right: 0, bottom: 0, left: 0 },
  origin: null,
  follow: true,
  editing: false,
  placed: false,
});

/** The words of an attribution, which may be written in HTML. */
const plain_text = (html: string): string =>
  new DOMParser().parseFromString(html, 'text/html').body.textContent;

/** The grid keeps its origin while one works near it. */
const grid_origin = (shown: Shown, here: LatLon): LatLon => {
  const wanted = shown.origin ?? shown.home ?? shown.robot?.at ?? shown.plan.spots[0] ?? here;
  const far = distance_m(wanted, here) > GRID_REACH_M;
  if (far) return { lat: Math.round(here.lat * 100) / 100, lon: Math.round(here.lon * 100) / 100 };
  if (shown.home ?? shown.robot ?? shown.plan.spots[0]) shown.origin = wanted;
  return wanted;
};

const paint_edited = (paint: Paint, shown: Shown): void => {
  const { plan, drag, look } = shown;
  const line =
    drag === null
      ? plan.line
      : drag.what === 'spot'
        ? with_point(plan.line, drag.k, drag.to)
        : with_inserted(plan.line, drag.k, drag.to);
  paint_plan(paint, plan, line, look);
};

const painters = (shown: Shown, trail: TrailLine, bar: ScaleBar): Painter[] => [
  (paint) => {
    const here = from_plane(paint.center);
    paint_grid(paint, palette(), grid_origin(shown, here), shown.cover);
    bar.show(paint.resolution / units_per_m(here.lat).east);
  },
  (paint) => {
    if (shown.route) paint_route(paint, shown.route, shown.current_item);
  },
  (paint) => trail.paint(paint, palette()),
  (paint) => paint_edited(paint, shown),
  (paint) => {
    if (shown.home) paint_home(paint, shown.home, palette());
  },
  (paint) => {
    if (shown.robot) paint_robot(paint, shown.robot, shown.size, palette());
  },
];

const make_ol_map = (target: HTMLElement, view: View): OlMap =>
  new OlMap({
    target,
    view,
    controls: [],
    interactions: default_interactions({
      altShiftDragRotate: false,
      pinchRotate: false,
      doubleClickZoom: false,
      keyboard: false,
    }),
    moveTolerance: 4,
  });

/** @param target fills the window; gets the scale bar too */
export const make_map = (target: HTMLElement): MapCalls => {
  const shown = nothing_shown();
  const trail = new TrailLine();
  const bar = make_scale_bar();
  const view = new View({
    center: [0, 0],
    zoom: WORLD_ZOOM,
    maxZoom: 25,
    enableRotation: false,
  });
  const map = make_ol_map(target, view);
  const tiles = new TileLayer<XYZ>({ visible: false });
  map.addLayer(tiles);
  map.addLayer(canvas_layer(painters(shown, trail, bar)));
  const credit = document.createElement('div');
  credit.className = 'map-credit';
  target.append(bar.element, credit);

  const edit = new EditInteraction({
    drawn: () => shown.plan,
    pixel_of: ([x, y]) => {
      const pixel = map.getPixelFromCoordinate([x, y]);
      return [pixel?.[0] ?? -1e9, pixel?.[1] ?? -1e9];
    },
    events: () => shown.events,
    show: (drag) => {
      shown.drag = drag;
      map.render();
    },
  });
  map.addInteraction(edit);
  map.on('click', (event) => edit.tap(event));
  map.on('pointerdrag', () => {
    if (shown.drag === null) shown.events.on_pan();
  });
  map.on('pointermove', (event) => {
    if (event.dragging) return;
    const free = shown.editing ? 'crosshair' : '';
    target.style.cursor = edit.over(event) ? 'pointer' : free;
  });
  on_palette_change(() => map.render());

  const center_on = (at: LatLon): void => view.setCenter([...to_plane(at)]);

  /** Whether a place is in sight and not under a panel. */
  const in_free_part = (at: LatLon): boolean => {
    const [width = 0, height = 0] = map.getSize() ?? [];
    const [x = -1, y = -1] = map.getPixelFromCoordinate([...to_plane(at)]) ?? [];
    const { top, right, bottom, left } = shown.cover;
    return x > left && x < width - right && y > top && y < height - bottom;
  };

  const fit = (points: readonly LatLon[]): void => {
    const first = points[0];
    if (!first) return;
    shown.placed = true;
    const [x, y] = to_plane(first);
    const extent: [number, number, number, number] = [x, y, x, y];
    for (const point of points) {
      const [px, py] = to_plane(point);
      extent[0] = Math.min(extent[0], px);
      extent[1] = Math.min(extent[1], py);
      extent[2] = Math.max(extent[2], px);
      extent[3] = Math.max(extent[3], py);
    }
    view.fit(extent, { padding: [48, 48, 48, 48], maxZoom: WORK_ZOOM + 1, duration: 0 });
  };

  return {
    listen: (events) => {
      shown.events = events;
    },
    set_mode: (mode) => {
      edit.set_mode(mode);
      shown.editing = mode === 'draw';
      shown.look = { ...shown.look, handles: mode !== 'watch' };
      map.render();
    },
    show_plan: (plan, selected, refused) => {
      const chosen = selected !== shown.look.selected;
      if (shown.plan_source !== plan) shown.plan = prepare_plan(plan);
      shown.plan_source = plan;
      shown.look = { ...shown.look, selected, refused };
      const spot = shown.plan.spots.find(({ index }) => index === selected);
      if (chosen && spot && !in_free_part(spot)) center_on(spot);
      map.render();
    },
    show_route: (route, current_item) => {
      if (shown.route_source !== route) {
        shown.route = route === null ? null : prepare_plan(route);
        shown.route_source = route;
      }
      shown.current_item = current_item;
      map.render();
    },
    show_robot: (robot, driven) => {
      trail.follow(driven);
      shown.robot = robot;
      if (robot && !shown.placed) {
        shown.placed = true;
        view.setZoom(WORK_ZOOM);
        center_on(robot.at);
      } else if (robot && shown.follow) {
        center_on(robot.at);
      }
      map.render();
    },
    set_size: (length_m, width_m) => {
      shown.size = { length_m, width_m };
    },
    show_home: (home) => {
      shown.home = home;
      map.render();
    },
    set_cover: (top, right, bottom, left) => {
      shown.cover = { top, right, bottom, left };
      view.padding = [top, right, bottom, left];
      map.updateSize();
      map.render();
    },
    set_follow: (follow) => {
      shown.follow = follow;
      if (follow && shown.robot) center_on(shown.robot.at);
    },
    fit,
    zoom_by: (levels) => {
      view.animate({ zoom: (view.getZoom() ?? WORLD_ZOOM) + levels, duration: 150 });
    },
    use_tiles: (set: TileSet | null) => {
      const usable = set !== null && set.format !== 'pbf';
      tiles.setVisible(usable);
      credit.textContent = usable ? plain_text(set.attribution) : '';
      if (!usable) return;
      tiles.setSource(
        new XYZ({
          url: `/api/v1/tiles/${encodeURIComponent(set.set)}/{z}/{x}/{y}`,
          minZoom: set.min_zoom,
          maxZoom: set.max_zoom,
        }),
      );
    },
  };
};
