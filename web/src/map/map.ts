// The map: tiles if there are any, and above them one canvas with grid, route, trail, mission and
// robot. It keeps what it was told to show and draws it in the next animation frame.

import type OlMap from 'ol/Map';
import type MapBrowserEvent from 'ol/MapBrowserEvent';
import View from 'ol/View';

import type { SpaceOnMap } from '../model/calibration';
import type { DrillOnMap } from '../model/drill';
import type { FenceDraft } from '../model/fence';
import type { Heat } from '../model/heat';
import { turn_deg, type MapUp } from '../model/map_up';
import type { KeptPlaces } from '../model/known_places';
import type { MeOnMap } from '../model/me';
import { EMPTY_PLAN, type LatLon, type Plan } from '../model/plan';
import type {
  DraftStorage,
  LineOnMap,
  MapCalls,
  MapEvents,
  MapMode,
  Mark,
  PlanShape,
  RobotOnMap,
  RouteOnMap,
} from '../model/ports';
import type { DriveOnMap } from '../model/route_drive';
import type { RunOnMap } from '../model/run_ports';
import type { AheadOnMap, SeenOnMap } from '../model/seen';
import { corners, type SiteEdit, type SiteOnMap } from '../model/site_map';
import type { Bounds } from '../model/tiling';
import type { Tracks } from '../model/tracks';
import type { TrailShades } from '../model/trail_shades';
import { layer_of } from './drawing';
import { prepare_drill } from './drill_painter';
import type { EditInteraction } from './edit';
import { GroundBelow } from './ground_layer';
import { make_hand } from './hand';
import { keep_view } from './last_view';
import { lazily } from './lazily';
import { make_ol_map } from './ol_map';
import { on_palette_change, style_legend } from './palette';
import { prepare_beside } from './pick_painter';
import { watch_pointer } from './pointer';
import { from_plane, to_plane } from './projection';
import { kept, Scene } from './scene';
import { prepare_heat, prepare_run } from './run_painter';
import { prepare_space } from './space_painter';
import { make_scale_bar } from './scale_bar';
import { clamp, FIT_MARGIN_PX, free_part, in_part, make_fit, pixel_of, push_view } from './sight';

/** Until something is known: the whole world, in degrees. */
const WORLD_ZOOM = 2;
/** About a hundred metres across a laptop screen at middle latitudes. */
const WORK_ZOOM = 20;
/** A vehicle fills a tenth of it. */
const CLOSE_ZOOM = 23;
const MAX_ZOOM = 25;

export class FieldMap implements MapCalls {
  readonly #target: HTMLElement;
  readonly #scene = new Scene();
  readonly #view = new View({
    center: [0, 0],
    zoom: WORLD_ZOOM,
    maxZoom: MAX_ZOOM,
    constrainRotation: false,
  });
  readonly #fit = make_fit(this.#view);
  readonly #map: OlMap;
  readonly #ground: GroundBelow;
  readonly #edit: EditInteraction;
  #mode: MapMode = 'watch';
  #follow = true;
  #up: MapUp = 'north';
  #turn_deg = 0;
  #turned: (turn_deg: number) => void = () => undefined;
  /** The press under way has marked a place already: its end is no tap. */
  #pressed_long = false;
  /** The view shows something that matters; before, the robot's first position sets it. */
  #placed = false;
  /** Most robots see nothing, and most pages need not draw it. */
  readonly #load_seen = lazily(
    () => import('./seen_painter'),
    (painter) => this.#with({ seen_painter: painter }),
  );
  readonly #load_site = lazily(
    () => import('./site_painter'),
    (painter) => this.#with({ site_painter: painter }),
  );

  /** @param target fills the window; gets the scale bar and the tiles' credit too
   * @param view_storage where one looks when nothing tells where the robot is */
  constructor(target: HTMLElement, view_storage: DraftStorage) {
    this.#target = target;
    const bar = make_scale_bar();
    this.#map = make_ol_map(target, this.#view);
    keep_view(this.#map, view_storage);
    this.#map.addLayer(layer_of(this.#scene, bar));
    this.#ground = new GroundBelow(this.#map);
    target.append(bar.element, this.#ground.credit);
    this.#edit = make_hand(this.#scene, this.#map, target);
    this.#map.addInteraction(this.#edit);
    this.#map.on('click', (event) => {
      if (!this.#pressed_long) this.#edit.tap(event);
    });
    this.#listen_for_long_press();
    this.#map.on('pointermove', (event) => this.#point(event));
    this.#map.on('pointerdrag', () => {
      const { drag, box } = this.#scene;
      if (!drag && !box && this.#mode !== 'point') this.#scene.events.on_pan();
    });
    style_legend();
    on_palette_change(() => {
      style_legend();
      this.#map.render();
    });
  }

  listen(events: MapEvents): void {
    this.#scene.events = events;
  }

  set_mode(mode: MapMode): void {
    this.#mode = mode;
    this.#edit.set_mode(mode);
    this.#turn();
    this.#scene.look = { ...this.#scene.look, handles: mode !== 'watch' };
    this.#map.render();
  }

  show_plan(
    plan: Plan,
    selected: number | null,
    refused: ReadonlySet<number>,
    shape: PlanShape,
    faint: boolean,
  ): void {
    const scene = this.#scene;
    const newly_chosen = selected !== null && selected !== scene.look.selected;
    scene.plan.take(plan);
    scene.look = { ...scene.look, selected, refused, shape, faint };
    if (newly_chosen) this.#reveal(selected);
    this.#map.render();
  }

  show_picked(picked: ReadonlySet<number>): void {
    this.#scene.picked = picked;
    this.#map.render();
  }

  show_beside(beside: readonly LineOnMap[]): void {
    this.#scene.beside = beside.map(prepare_beside);
    this.#map.render();
  }

  set_snap(snaps: boolean): void {
    this.#scene.snaps = snaps;
  }

  show_route({ plan, way, current_item, corridor_m }: RouteOnMap): void {
    [this.#scene.corridor_m, this.#scene.current_item] = [corridor_m, current_item];
    this.#scene.route.take(plan ?? EMPTY_PLAN);
    this.#scene.take_way(way);
    this.#map.render();
  }

  show_drive(drive: DriveOnMap | null): void {
    this.#scene.take_drive(drive);
    this.#map.render();
  }

  show_robot(robot: RobotOnMap | null, tracks: Tracks): void {
    this.#scene.driven.follow(tracks.driven);
    this.#scene.fixes.follow(tracks.fixes);
    this.#scene.robot = robot;
    this.#turn();
    if (robot && !this.#placed) {
      this.#placed = true;
      this.#view.setZoom(WORK_ZOOM);
      this.#center_on(robot.at);
    } else if (robot && this.#follow) {
      this.#center_on(robot.at);
    }
    this.#map.render();
  }

  show_trail(shades: TrailShades | null): void {
    this.#scene.trail_shades = shades;
    this.#map.render();
  }

  show_home(home: LatLon | null): void {
    this.#scene.home = kept(this.#scene.home, home);
    this.#map.render();
  }

  show_runs(runs: readonly RunOnMap[]): void {
    this.#scene.runs = runs.map(prepare_run);
    this.#map.render();
  }

  show_heat(heat: Heat | null): void {
    this.#scene.heat = heat && prepare_heat(heat);
    this.#map.render();
  }

  show_places(kept: KeptPlaces): void {
    this.#scene.keep(kept);
    if (kept.graph) this.#load_site();
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

  show_marks(pin: Mark | null, goal: Mark | null, me: MeOnMap | null): void {
    this.#scene.pin = kept(this.#scene.pin, pin);
    [this.#scene.goal, this.#scene.me] = [goal, me];
    this.#map.render();
  }

  show_seen(seen: SeenOnMap | null): void {
    this.#scene.seen = seen;
    if (seen) this.#load_seen();
    this.#map.render();
  }

  show_ahead(ahead: AheadOnMap | null): void {
    this.#scene.ahead = ahead;
    if (ahead) this.#load_seen();
    this.#map.render();
  }

  show_site(site: SiteOnMap | null): void {
    this.#scene.site = site;
    if (site) this.#load_site();
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

  keep_up(up: MapUp, turned: (turn_deg: number) => void): void {
    this.#up = up;
    this.#turned = turned;
    this.#turn();
    turned(this.#turn_deg);
  }

  set_follow(follow: boolean): void {
    this.#follow = follow;
    this.#turn();
    if (follow && this.#scene.robot) this.#center_on(this.#scene.robot.at);
  }

  fit(points: readonly LatLon[], closely = false): void {
    if (points.length === 0) return;
    this.#placed = true;
    const free = free_part(this.#map.getSize() ?? [0, 0], this.#scene.cover);
    void this.#fit(points, free, closely ? CLOSE_ZOOM : WORK_ZOOM + 1, this.#target);
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

  use_ground: MapCalls['use_ground'] = (ground, told) => this.#ground.use(ground, told);

  view_bounds(): Bounds | null {
    const size = this.#map.getSize();
    if (!size) return null;
    const [west = 0, south = 0, east = 0, north = 0] = this.#view.calculateExtent(size);
    const a = from_plane([west, south]);
    const b = from_plane([east, north]);
    return { west: a.lon, south: a.lat, east: b.lon, north: b.lat };
  }

  zoom_level(): number {
    return Math.round(this.#view.getZoom() ?? WORLD_ZOOM);
  }

  #with(painters: Partial<Pick<Scene, 'seen_painter' | 'site_painter'>>): void {
    Object.assign(this.#scene, painters);
    this.#map.render();
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

  #point(event: MapBrowserEvent): void {
    if (event.dragging) return;
    const free = this.#mode === 'watch' || this.#mode === 'edit' ? '' : 'crosshair';
    this.#target.style.cursor = this.#edit.over(event) ? 'pointer' : free;
  }

  #turn(): void {
    const { robot } = this.#scene;
    const next_deg = turn_deg(this.#turn_deg, {
      up: this.#up,
      drawn_on: this.#mode !== 'watch',
      follows: this.#follow,
      heading_deg: robot?.stale ? null : (robot?.heading_deg ?? null),
    });
    if (next_deg === this.#turn_deg) return;
    this.#turn_deg = next_deg;
    this.#view.setRotation((next_deg * Math.PI) / 180);
    this.#turned(next_deg);
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
    const [x, y] = pixel_of(this.#view, at, free);
    const margin = Math.min(FIT_MARGIN_PX, free.width / 2, free.height / 2);
    const right = clamp(x, free.left + margin, free.left + free.width - margin) - x;
    const down = clamp(y, free.top + margin, free.top + free.height - margin) - y;
    push_view(this.#view, right, down);
  }

  #in_sight(at: LatLon, margin = 0): boolean {
    const free = free_part(this.#map.getSize() ?? [0, 0], this.#scene.cover);
    return in_part(pixel_of(this.#view, at, free), free, margin);
  }
}
