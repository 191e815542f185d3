// The map: tiles if there are any, and above them one canvas with grid, route, trail, mission and
// robot. It keeps what it was told to show and draws it in the next animation frame.

import OlMap from 'ol/Map';
import type MapBrowserEvent from 'ol/MapBrowserEvent';
import View from 'ol/View';
import { defaults as default_interactions } from 'ol/interaction/defaults';
import TileLayer from 'ol/layer/Tile';
import XYZ from 'ol/source/XYZ';

import type { SpaceOnMap } from '../model/calibration';
import type { FenceDraft } from '../model/fence';
import { EMPTY_PLAN, type LatLon, type Plan } from '../model/plan';
import type {
  DraftStorage,
  DrillOnMap,
  MapCalls,
  MapEvents,
  MapMode,
  Mark,
  PlanShape,
  RobotOnMap,
  RunOnMap,
  TileSet,
} from '../model/ports';
import type { AheadOnMap, SeenOnMap } from '../model/seen';
import { corners, type SiteEdit, type SiteOnMap } from '../model/site_map';
import type { Tracks } from '../model/tracks';
import { canvas_layer } from './canvas';
import type { Slip } from '../model/slips';
import { prepare_drill } from './drill_painter';
import { prepare_slips } from './slip_painter';
import { EditInteraction } from './edit';
import { keep_view } from './last_view';
import { on_palette_change } from './palette';
import { watch_pointer } from './pointer';
import { from_plane, to_plane, to_plane_line } from './projection';
import { Scene } from './scene';
import { prepare_run } from './run_painter';
import { prepare_space } from './space_painter';
import { make_scale_bar } from './scale_bar';
import { clamp, extent_of, free_part, type FreePart } from './sight';

/** Until something is known: the whole world, in degrees. */
const WORLD_ZOOM = 2;
/** About a hundred metres across a laptop screen at middle latitudes. */
const WORK_ZOOM = 20;
/** A vehicle fills a tenth of it. */
const CLOSE_ZOOM = 23;
const MAX_ZOOM = 25;
const FIT_MARGIN_PX = 48;

const make_ol_map = (target: HTMLElement, view: View): OlMap =>
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

/** The words of an attribution, which may be written in HTML. */
const plain_text = (html: string): string =>
  new DOMParser().parseFromString(html, 'text/html').body.textContent;

export class FieldMap implements MapCalls {
  readonly #target: HTMLElement;
  readonly #scene = new Scene();
  readonly #view = new View({
    center: [0, 0],
    zoom: WORLD_ZOOM,
    maxZoom: MAX_ZOOM,
    enableRotation: false,
  });
  readonly #map: OlMap;
  readonly #tiles = new TileLayer<XYZ>({ visible: false });
  readonly #credit = document.createElement('div');
  readonly #edit: EditInteraction;
  #mode: MapMode = 'watch';
  #follow = true;
  /** The press under way has marked a place already: its end is no tap. */
  #pressed_long = false;
  /** The view shows something that matters; before, the robot's first position sets it. */
  #placed = false;
  #seen_asked = false;
  #site_asked = false;

  /** @param target fills the window; gets the scale bar and the tiles' credit too
   * @param view_storage where one looks when nothing tells where the robot is */
  constructor(target: HTMLElement, view_storage: DraftStorage) {
    this.#target = target;
    const bar = make_scale_bar();
    this.#map = make_ol_map(target, this.#view);
    keep_view(this.#map, view_storage);
    this.#map.addLayer(this.#tiles);
    this.#map.addLayer(canvas_layer(this.#scene.painters(bar)));
    this.#credit.className = 'map-credit';
    target.append(bar.element, this.#credit);
    this.#edit = this.#make_edit();
    this.#map.addInteraction(this.#edit);
    this.#map.on('click', (event) => {
      if (!this.#pressed_long) this.#edit.tap(event);
    });
    this.#listen_for_long_press();
    this.#map.on('pointermove', (event) => this.#point(event));
    this.#map.on('pointerdrag', () => {
      if (this.#scene.drag === null && this.#mode !== 'point') this.#scene.events.on_pan();
    });
    on_palette_change(() => this.#map.render());
  }

  listen(events: MapEvents): void {
    this.#scene.events = events;
  }

  set_mode(mode: MapMode): void {
    this.#mode = mode;
    this.#edit.set_mode(mode);
    this.#scene.look = { ...this.#scene.look, handles: mode !== 'watch' };
    this.#map.render();
  }

  show_plan(
    plan: Plan,
    selected: number | null,
    refused: ReadonlySet<number>,
    shape: PlanShape,
  ): void {
    const scene = this.#scene;
    const newly_chosen = selected !== null && selected !== scene.look.selected;
    scene.plan.take(plan);
    scene.look = { ...scene.look, selected, refused, shape };
    if (newly_chosen) this.#reveal(selected);
    this.#map.render();
  }

  /** @param way the route as it is laid out; empty: not known */
  show_route(route: Plan | null, way: readonly LatLon[], current_item: number): void {
    this.#scene.route.take(route ?? EMPTY_PLAN);
    this.#scene.way = to_plane_line(way);
    this.#scene.current_item = current_item;
    this.#map.render();
  }

  show_robot(robot: RobotOnMap | null, tracks: Tracks): void {
    this.#scene.driven.follow(tracks.driven);
    this.#scene.fixes.follow(tracks.fixes);
    this.#scene.robot = robot;
    if (robot && !this.#placed) {
      this.#placed = true;
      this.#view.setZoom(WORK_ZOOM);
      this.#center_on(robot.at);
    } else if (robot && this.#follow) {
      this.#center_on(robot.at);
    }
    this.#map.render();
  }

  show_home(home: LatLon | null): void {
    this.#scene.home = home;
    this.#map.render();
  }

  show_runs(runs: readonly RunOnMap[]): void {
    this.#scene.runs = runs.map(prepare_run);
    this.#map.render();
  }

  show_slips(slips: readonly Slip[]): void {
    this.#scene.slips = prepare_slips(slips);
    this.#map.render();
  }

  show_space(space: SpaceOnMap | null): void {
    this.#scene.space = space && prepare_space(space);
    this.#map.render();
  }

  show_drill(drill: DrillOnMap | null): void {
    this.#scene.drill = drill && prepare_drill(drill);
    this.#map.render();
  }

  show_fence(fence: FenceDraft | null): void {
    this.#scene.fence = fence;
    this.#map.render();
  }

  show_marks(pin: Mark | null, goal: Mark | null): void {
    this.#scene.pin = pin;
    this.#scene.goal = goal;
    this.#map.render();
  }

  show_seen(seen: SeenOnMap | null): void {
    this.#scene.seen = seen;
    if (seen) this.#load_seen_painter();
    this.#map.render();
  }

  show_ahead(ahead: AheadOnMap | null): void {
    this.#scene.ahead = ahead;
    if (ahead) this.#load_seen_painter();
    this.#map.render();
  }

  show_site(site: SiteOnMap | null): void {
    this.#scene.site = site;
    if (site) this.#load_site_painter();
    // Where satellites tell nothing the robot may be found by hand.
    if (site && !this.#placed) this.fit(corners(site.map, site.at), true);
    this.#map.render();
  }

  show_site_edits(edits: readonly SiteEdit[]): void {
    this.#scene.site_edits = edits;
    this.#map.render();
  }

  set_size(length_m: number, width_m: number): void {
    this.#scene.size = { length_m, width_m };
  }

  set_cover(top: number, right: number, bottom: number, left: number): void {
    const kept = this.#kept_in_sight();
    this.#scene.cover = { top, right, bottom, left };
    this.#view.padding = [top, right, bottom, left]; // what is drawn stays where it is
    this.#map.updateSize();
    if (this.#follow && this.#scene.robot) this.#center_on(this.#scene.robot.at);
    else if (kept && this.#scene.drag === null) this.#keep_in_sight(kept);
    this.#map.render();
  }

  set_follow(follow: boolean): void {
    this.#follow = follow;
    if (follow && this.#scene.robot) this.#center_on(this.#scene.robot.at);
  }

  fit(points: readonly LatLon[], closely = false): void {
    if (points.length === 0) return;
    this.#placed = true;
    const padding = Array<number>(4).fill(FIT_MARGIN_PX);
    this.#view.fit(extent_of(points), { padding, maxZoom: closely ? CLOSE_ZOOM : WORK_ZOOM + 1 });
  }

  center_robot(): void {
    if (this.#scene.robot) this.#center_on(this.#scene.robot.at);
  }

  /** @param moved hears which place lies under the mouse; null: none */
  watch_pointer(moved: (at: LatLon | null) => void): void {
    watch_pointer(this.#map, this.#target, moved);
  }

  zoom_by(levels: number): void {
    this.#view.animate({ zoom: (this.#view.getZoom() ?? WORLD_ZOOM) + levels, duration: 150 });
  }

  use_tiles(set: TileSet | null): void {
    const usable = set !== null && set.format !== 'pbf';
    this.#tiles.setVisible(usable);
    this.#credit.textContent = usable ? plain_text(set.attribution) : '';
    if (!usable) return;
    const source = new XYZ({
      url: `/api/v1/tiles/${encodeURIComponent(set.set)}/{z}/{x}/{y}`,
      minZoom: set.min_zoom,
      maxZoom: set.max_zoom,
    });
    this.#tiles.setSource(source);
  }

  /** Most robots see nothing, and most pages need not draw it. */
  #load_seen_painter(): void {
    if (this.#seen_asked) return;
    this.#seen_asked = true;
    import('./seen_painter').then(
      (painter) => {
        this.#scene.seen_painter = painter;
        this.#map.render();
      },
      () => (this.#seen_asked = false), // again with the next picture
    );
  }

  /** Likewise. */
  #load_site_painter(): void {
    if (this.#site_asked) return;
    this.#site_asked = true;
    import('./site_painter').then(
      (painter) => {
        this.#scene.site_painter = painter;
        this.#map.render();
      },
      () => (this.#site_asked = false),
    );
  }

  /** A finger that rests, or the right mouse button: marks a place, also where a tap would select. */
  #listen_for_long_press(): void {
    this.#target.addEventListener('pointerdown', () => (this.#pressed_long = false));
    this.#target.addEventListener('contextmenu', (event) => {
      event.preventDefault();
      if (this.#scene.drag !== null || this.#mode === 'point') return;
      this.#pressed_long = true;
      this.#scene.events.on_place(from_plane(this.#map.getEventCoordinate(event)));
    });
  }

  #make_edit(): EditInteraction {
    return new EditInteraction({
      drawn: () => this.#scene.plan.drawn,
      events: () => this.#scene.events,
      pixel_of: ([x, y]) => {
        const pixel = this.#map.getPixelFromCoordinate([x, y]);
        return [pixel?.[0] ?? -1e9, pixel?.[1] ?? -1e9];
      },
      show: (drag) => {
        this.#scene.drag = drag;
        this.#map.render();
      },
    });
  }

  #point(event: MapBrowserEvent): void {
    if (event.dragging) return;
    const free = this.#mode === 'draw' || this.#mode === 'point' ? 'crosshair' : '';
    this.#target.style.cursor = this.#edit.over(event) ? 'pointer' : free;
  }

  #center_on(at: LatLon): void {
    this.#view.setCenter([...to_plane(at)]);
  }

  /** Brings an item into the part of the map that no panel covers. */
  #reveal(index: number): void {
    const spot = this.#spot(index);
    if (!spot || this.#in_sight(spot)) return;
    this.#center_on(spot);
  }

  #spot(index: number | null): LatLon | null {
    return this.#scene.plan.drawn.spots.find((each) => each.index === index) ?? null;
  }

  /** What a person looks at, if it can be seen: the edited item, else the robot. */
  #kept_in_sight(): LatLon | null {
    const wanted = this.#spot(this.#scene.look.selected) ?? this.#scene.robot?.at ?? null;
    return wanted && this.#in_sight(wanted) ? wanted : null;
  }

  /** The edited item moves just as far as needed; the robot goes back to the middle. */
  #keep_in_sight(at: LatLon): void {
    if (this.#in_sight(at, FIT_MARGIN_PX)) return;
    if (this.#spot(this.#scene.look.selected)) this.#uncover(at);
    else this.#center_on(at);
  }

  /** Moves the map just as far as needed. */
  #uncover(at: LatLon): void {
    const free = free_part(this.#map.getSize() ?? [0, 0], this.#scene.cover);
    const [x, y] = this.#pixel_of(at, free);
    const margin = Math.min(FIT_MARGIN_PX, free.width / 2, free.height / 2);
    const right = clamp(x, free.left + margin, free.left + free.width - margin) - x;
    const down = clamp(y, free.top + margin, free.top + free.height - margin) - y;
    const [center_x = 0, center_y = 0] = this.#view.getCenter() ?? [];
    const resolution = this.#view.getResolution() ?? 1;
    this.#view.setCenter([center_x - right * resolution, center_y + down * resolution]);
  }

  #in_sight(at: LatLon, margin = 0): boolean {
    const free = free_part(this.#map.getSize() ?? [0, 0], this.#scene.cover);
    const [x, y] = this.#pixel_of(at, free);
    const across = x > free.left + margin && x < free.left + free.width - margin;
    return across && y > free.top + margin && y < free.top + free.height - margin;
  }

  /** Where it will be drawn; the map itself knows only where it was in the last frame. */
  #pixel_of(at: LatLon, free: FreePart): readonly [x: number, y: number] {
    const [x, y] = to_plane(at);
    const [center_x = 0, center_y = 0] = this.#view.getCenter() ?? [];
    const resolution = this.#view.getResolution() ?? 1;
    return [
      free.left + free.width / 2 + (x - center_x) / resolution,
      free.top + free.height / 2 - (y - center_y) / resolution,
    ];
  }
}
