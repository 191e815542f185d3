// What the map was told to show, and the painters that draw it, in order.

import { distance_m } from '../model/geo';
import type { FenceDraft } from '../model/fence';
import type { KeptPlaces } from '../model/known_places';
import type { MeOnMap } from '../model/me';
import { EMPTY_PLAN, type LatLon } from '../model/plan';
import { NO_EVENTS, type MapEvents } from '../model/on_map';
import type { Mark, RobotOnMap } from '../model/ports';
import { language_now } from '../model/say';
import { DrawnUpTo } from '../model/drawn_up_to';
import type { DriveOnMap } from '../model/route_drive';
import type { TrailShades } from '../model/trail_shades';
import type { AheadOnMap, SeenOnMap } from '../model/seen';
import { away_spot, paint_away } from './away_painter';
import type { SiteEdit, SiteOnMap } from '../model/site_map';
import { pixels_of, type Mover, type Paint, type Painter, type Pixels, type View } from './canvas';
import { around_px, box_of, goal_box, whole } from './boxes';
import { paint_drive, prepare_drive, type DrawnDrive } from './drive_painter';
import { paint_drill, type DrawnDrill } from './drill_painter';
import { edited_movers, paint_edited, type Edited } from './edited_painter';
import type { Box, Drag } from './edit';
import { paint_fence } from './fence_painter';
import { paint_grid, type Cover } from './grid';
import { paint_goal, paint_pin } from './mark_painter';
import { me_box, paint_me } from './me_painter';
import { palette } from './palette';
import type { DrawnBeside } from './pick_painter';
import { ProjectedPlan, type PlanLook } from './plan_painter';
import { from_plane, type PlaneLine, to_plane_line } from './projection';
import {
  accuracy_box,
  paint_accuracy,
  paint_home,
  paint_robot,
  paint_wedge,
  robot_box,
  wedge_box,
  type Size,
} from './robot_painter';
import {
  paint_corridor,
  paint_route,
  paint_target,
  paint_way,
  target_box,
  target_of,
} from './route_painter';
import { paint_heat, paint_runs, type DrawnHeat, type DrawnRun } from './run_painter';
import type * as SeenPainter from './seen_painter';
import type * as SitePainter from './site_painter';
import { paint_space, type DrawnSpace } from './space_painter';
import { paint_kept, prepare_kept, type DrawnKept } from './kept_painter';
import type { Stays } from './still';
import { TrailLine } from './trail_line';

/** Beyond this from its origin the grid gets a new one. */
const GRID_REACH_M = 10_000;

/** The same values, one by one. */
const alike = (old: readonly unknown[], now: readonly unknown[]): boolean =>
  old.length === now.length && now.every((value, k) => value === old[k]);

/** The old one if the new one says the same: what is drawn of it need not be drawn again. */
export const kept = <T extends object>(old: T | null, next: T | null): T | null =>
  JSON.stringify(old) === JSON.stringify(next) ? old : next;

/** Fields of what moves, or is not drawn. */
const MOVES: ReadonlySet<string> = new Set([
  'events',
  'drag',
  'box',
  'snaps',
  'robot',
  'seen',
  'ahead',
  'goal',
  'me',
  'current_item',
  'cover',
]);

/** Fields of which nothing is drawn under the edited mission. */
const EDITED: ReadonlySet<string> = new Set(['plan', 'look', 'picked', 'beside', 'drill', 'pin']);

export class Scene {
  events: MapEvents = NO_EVENTS;
  readonly plan = new ProjectedPlan(EMPTY_PLAN);
  readonly route = new ProjectedPlan(EMPTY_PLAN);
  /** The route as it is laid out. */
  way: PlaneLine = to_plane_line([]);
  readonly driven = new TrailLine();
  readonly fixes = new TrailLine();
  /** Null: in one colour. */
  trail_shades: TrailShades | null = null;
  look: PlanLook = {
    selected: null,
    refused: new Set(),
    handles: false,
    faint: false,
    shape: 'line',
  };
  drag: Drag | null = null;
  /** The box that chooses points. */
  box: Box | null = null;
  picked: ReadonlySet<number> = new Set();
  /** A dragged point is caught by what lies near. */
  snaps = false;
  /** Shown to compare. */
  beside: readonly DrawnBeside[] = [];
  current_item = 0;
  /** How the route is to be driven; null: not shown. */
  drive: DrawnDrive | null = null;
  /** To both sides of the route; null: not known. */
  corridor_m: number | null = null;
  robot: RobotOnMap | null = null;
  home: LatLon | null = null;
  runs: readonly DrawnRun[] = [];
  heat: DrawnHeat | null = null;
  drill: DrawnDrill | null = null;
  space: DrawnSpace | null = null;
  places: DrawnKept | null = null;
  fence: FenceDraft | null = null;
  site: SiteOnMap | null = null;
  site_edits: readonly SiteEdit[] = [];
  /** Loaded when a map of a place is looked at. */
  site_painter: typeof SitePainter | null = null;
  seen: SeenOnMap | null = null;
  ahead: AheadOnMap | null = null;
  /** Loaded when a robot with sensors is looked at. */
  seen_painter: typeof SeenPainter | null = null;
  /** The place that the person chose. */
  pin: Mark | null = null;
  /** Where the robot drives to outside of a mission. */
  goal: Mark | null = null;
  /** Where this device is. */
  me: MeOnMap | null = null;
  size: Size = { length_m: 1, width_m: 0.8 };
  cover: Cover = { top: 0, right: 0, bottom: 0, left: 0 };
  #origin: LatLon | null = null;
  #way_from: readonly LatLon[] = [];
  /** Up to where the route is drawn as done. */
  readonly #route_at = new DrawnUpTo();
  /** All of what stays, as it was drawn last. */
  #below_of: readonly unknown[] = [];
  #edited_of: readonly unknown[] = [];
  /** It is being drawn, and what is seen of it is what it was before. */
  #edited_waits = false;
  #last_drag: Drag | null = null;

  keep(places: KeptPlaces): void {
    this.places = prepare_kept(places);
  }

  take_drive(drive: DriveOnMap | null): void {
    this.drive = drive && prepare_drive(drive, this.drive);
  }

  /** Projected once. */
  take_way(way: readonly LatLon[]): void {
    if (way !== this.#way_from) this.way = to_plane_line(way);
    this.#way_from = way;
  }

  /** The grid keeps its origin while one works near it. */
  grid_origin(here: LatLon): LatLon {
    const known = this.home ?? this.robot?.at ?? this.plan.drawn.spots[0] ?? null;
    const wanted = this.#origin ?? known ?? here;
    if (distance_m(wanted, here) > GRID_REACH_M) {
      return { lat: Math.round(here.lat * 100) / 100, lon: Math.round(here.lon * 100) / 100 };
    }
    if (known) this.#origin = wanted;
    return wanted;
  }

  /** What is drawn once, in order: what lies under the edited mission, and what does not. */
  still(): Stays[] {
    return [
      {
        painters: this.#below(),
        changed: () => this.#below_changed(),
        begin: () => {
          this.#route_at.begin(this.current_item);
          this.driven.begin();
          this.fixes.begin();
        },
        shown: () => {
          this.#route_at.keep(performance.now());
          this.driven.keep();
          this.fixes.keep();
        },
      },
      {
        painters: this.#edited(),
        changed: () => this.#edited_changed(),
        begin: () => (this.#edited_waits = true),
        shown: () => (this.#edited_waits = false),
      },
    ];
  }

  #below(): Painter[] {
    return [
      (paint) => paint_grid(paint, palette(), this.grid_origin(from_plane(paint.center))),
      (paint) => {
        if (this.site) this.site_painter?.paint_site(paint, this.site);
      },
      (paint) => this.site_painter?.paint_site_edits(paint, this.site_edits, palette()),
      (paint) => {
        if (this.fence) paint_fence(paint, this.fence, palette());
      },
      (paint) => {
        if (this.space) paint_space(paint, this.space, palette());
      },
      (paint) => {
        if (this.runs.length > 0 || this.heat) return;
        const { begun } = this.#route_at;
        if (this.corridor_m !== null) {
          paint_corridor(paint, this.route.drawn, begun, this.corridor_m);
        }
        paint_route(paint, this.route.drawn, begun, this.drive);
        paint_way(paint, this.way);
      },
      (paint) => this.#paint_driven(paint),
      (paint) => {
        if (!this.places) return;
        const { graph } = this.places;
        if (graph) this.site_painter?.paint_graph(paint, graph, palette());
        paint_kept(paint, this.places, palette());
      },
    ];
  }

  #edited(): Painter[] {
    return [
      (paint) => paint_edited(paint, this),
      (paint) => {
        if (!this.drive || this.runs.length > 0 || this.heat) return;
        paint_drive(paint, this.route.drawn, this.drive, this.current_item);
      },
      (paint) => {
        if (this.drill) paint_drill(paint, this.drill, this.size, palette());
      },
      (paint) => {
        if (this.home) paint_home(paint, this.home, palette());
      },
      (paint) => {
        if (this.pin) paint_pin(paint, this.pin, palette());
      },
    ];
  }

  /** What moves, under all that. */
  ground(view: View): Mover[] {
    const pixels = pixels_of(view, 0);
    const { robot, seen } = this;
    return [
      {
        box: robot && accuracy_box(pixels, robot),
        paint: (paint) => robot && paint_accuracy(paint, robot, palette()),
      },
      {
        box: robot && wedge_box(pixels, robot),
        paint: (paint) => robot && paint_wedge(paint, robot, palette().wedge),
      },
      {
        box: seen?.grid ? whole(view) : null,
        paint: (paint) => this.seen_painter?.paint_ground(paint, seen?.grid ?? null),
      },
    ];
  }

  /** A ring around the item that is driven to. */
  target(view: View): Mover[] {
    if (this.runs.length > 0 || this.heat) return [];
    const at = target_of(this.route.drawn, this.current_item);
    if (!at) return [];
    return [{ box: target_box(pixels_of(view, 0), at), paint: (paint) => paint_target(paint, at) }];
  }

  /** What moves, above it. */
  moving(view: View): Mover[] {
    const pixels = pixels_of(view, 0);
    const { robot, goal, me, seen, ahead } = this;
    return [
      ...this.#tips(pixels),
      ...edited_movers(view, this.#edited_as_seen()),
      {
        box: goal && goal_box(pixels, goal, robot?.at ?? null),
        paint: (paint) => goal && paint_goal(paint, goal, robot?.at ?? null, palette()),
      },
      {
        box: me && me_box(pixels, me),
        paint: (paint) => me && paint_me(paint, me, palette()),
      },
      {
        box: seen || ahead ? whole(view) : null,
        paint: (paint) => {
          if (ahead) this.seen_painter?.paint_ahead(paint, ahead, palette());
          if (seen) this.seen_painter?.paint_seen(paint, seen, palette());
        },
      },
      {
        box: robot && robot_box(pixels, robot, this.size),
        paint: (paint) => robot && paint_robot(paint, robot, this.size, palette()),
      },
      {
        box: ahead ? whole(view) : null,
        paint: (paint) => ahead && this.seen_painter?.paint_block(paint, ahead, palette()),
      },
    ];
  }

  /** What was dragged stays where it was dropped until the rest has caught up. */
  #edited_as_seen(): Edited {
    if (this.drag || !this.#edited_waits) this.#last_drag = this.drag;
    const { plan, look, box, picked, beside } = this;
    return { plan, look, box, picked, beside, drag: this.#last_drag };
  }

  /** Where a robot out of sight is. */
  above(view: View): Mover[] {
    const { robot } = this;
    const spot = robot && away_spot(view, robot, this.cover);
    if (!robot || !spot) return [];
    return [
      {
        box: around_px(spot.x, spot.y, 110),
        paint: (paint) => paint_away(paint, robot, spot, palette()),
      },
    ];
  }

  /**
   * Whether anything of what is drawn once is another one than when this was asked last. Every field
   * counts but those that are known to move, or to lie above: a field that is forgotten costs time, and
   * is never wrong.
   */
  #below_changed(): boolean {
    const first = this.home || this.robot ? null : this.plan.drawn.spots[0]; // of the grid
    const now = this.#fields((name) => !EDITED.has(name));
    now.push(this.route.drawn, first?.lat, first?.lon);
    const same = alike(this.#below_of, now);
    this.#below_of = now;
    const behind = this.#route_at.is_behind(this.current_item, performance.now());
    return !same || behind || this.driven.tip() === null || this.fixes.tip() === null;
  }

  #edited_changed(): boolean {
    const now = this.#fields(() => true);
    now.push(this.plan.drawn, this.route.drawn, this.#drag_key(), this.#route_at.item);
    const same = alike(this.#edited_of, now);
    this.#edited_of = now;
    return !same;
  }

  #fields(counts: (name: string) => boolean): unknown[] {
    const all = Object.entries(this).filter(([name]) => !MOVES.has(name) && counts(name));
    return [palette(), language_now(), ...all.map(([, value]): unknown => value)];
  }

  /** Which point is dragged, wherever it is. */
  #drag_key(): string {
    return this.drag ? `${this.drag.what} ${this.drag.k}` : '';
  }

  #paint_driven(paint: Paint): void {
    if (this.heat) paint_heat(paint, this.heat, palette());
    if (this.runs.length > 0) paint_runs(paint, this.runs, this.size, palette());
    if (this.heat || this.runs.length > 0) return;
    this.fixes.paint_dots(paint, palette().fixes);
    this.#paint_trail(paint);
  }

  #paint_trail(paint: Paint, begin = 0): void {
    const shades = this.trail_shades;
    if (shades) this.driven.paint_shaded(paint, palette(), shades, begin);
    else this.driven.paint_line(paint, palette(), begin);
  }

  /** What was driven since. */
  #tips(pixels: Pixels): Mover[] {
    if (this.heat || this.runs.length > 0) return [];
    const [fixes, driven] = [this.fixes.tip() ?? 0, this.driven.tip() ?? 0];
    return [
      {
        box: box_of(pixels, this.fixes.places(fixes), 5),
        paint: (paint) => this.fixes.paint_dots(paint, palette().fixes, fixes),
      },
      {
        box: box_of(pixels, this.driven.places(driven), 7),
        paint: (paint) => this.#paint_trail(paint, driven),
      },
    ];
  }
}
