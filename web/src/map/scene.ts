// What the map was told to show, and the painters that draw it, in order.

import { distance_m } from '../model/geo';
import type { FenceDraft } from '../model/fence';
import { EMPTY_PLAN, type LatLon, type Plan } from '../model/plan';
import type { MapEvents, Mark, RobotOnMap } from '../model/ports';
import type { AheadOnMap, SeenOnMap } from '../model/seen';
import { paint_away } from './away_painter';
import type { SiteEdit, SiteOnMap } from '../model/site_map';
import { ring_behind } from './band';
import type { Paint, Painter } from './canvas';
import { paint_drill, type DrawnDrill } from './drill_painter';
import type { Drag } from './edit';
import { paint_fence } from './fence_painter';
import { paint_grid, type Cover } from './grid';
import { paint_goal, paint_pin } from './mark_painter';
import { palette } from './palette';
import {
  paint_plan,
  paint_route,
  paint_way,
  prepare_plan,
  with_inserted,
  with_point,
  type DrawnPlan,
  type PlanLook,
} from './plan_painter';
import { from_plane, type PlaneLine, to_plane_line, units_per_m } from './projection';
import { paint_accuracy, paint_home, paint_robot, TrailLine, type Size } from './robot_painter';
import { paint_runs, type DrawnRun } from './run_painter';
import type { ScaleBar } from './scale_bar';
import type * as SeenPainter from './seen_painter';
import type * as SitePainter from './site_painter';
import { paint_space, type DrawnSpace } from './space_painter';
import { paint_slips, type DrawnSlip } from './slip_painter';

/** Beyond this from its origin the grid gets a new one. */
const GRID_REACH_M = 10_000;

const NO_EVENTS: MapEvents = {
  on_add: () => undefined,
  on_insert: () => undefined,
  on_move: () => undefined,
  on_select: () => undefined,
  on_place: () => undefined,
  on_point: () => undefined,
  on_pan: () => undefined,
};

/** A plan, projected once: when it changes. */
class Projected {
  #source: Plan;
  drawn: DrawnPlan;

  constructor(plan: Plan) {
    this.#source = plan;
    this.drawn = prepare_plan(plan);
  }

  take(plan: Plan): void {
    if (this.#source === plan) return;
    this.#source = plan;
    this.drawn = prepare_plan(plan);
  }
}

export class Scene {
  events = NO_EVENTS;
  readonly plan = new Projected(EMPTY_PLAN);
  readonly route = new Projected(EMPTY_PLAN);
  /** The route as it is laid out. */
  way: PlaneLine = to_plane_line([]);
  readonly driven = new TrailLine();
  readonly fixes = new TrailLine();
  look: PlanLook = { selected: null, refused: new Set(), handles: false, shape: 'line' };
  drag: Drag | null = null;
  current_item = 0;
  robot: RobotOnMap | null = null;
  home: LatLon | null = null;
  runs: readonly DrawnRun[] = [];
  drill: DrawnDrill | null = null;
  space: DrawnSpace | null = null;
  slips: readonly DrawnSlip[] = [];
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
  size: Size = { length_m: 1, width_m: 0.8 };
  cover: Cover = { top: 0, right: 0, bottom: 0, left: 0 };
  #origin: LatLon | null = null;

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

  painters(bar: ScaleBar): Painter[] {
    return [
      (paint) => {
        const here = from_plane(paint.center);
        paint_grid(paint, palette(), this.grid_origin(here), this.cover);
        bar.show(paint.resolution / units_per_m(here.lat).east);
      },
      (paint) => {
        if (this.site) this.site_painter?.paint_site(paint, this.site);
      },
      (paint) => this.site_painter?.paint_site_edits(paint, this.site_edits, palette()),
      (paint) => {
        if (this.robot) paint_accuracy(paint, this.robot, palette());
      },
      (paint) => {
        if (this.seen) this.seen_painter?.paint_ground(paint, this.seen.grid);
      },
      (paint) => {
        if (this.fence) paint_fence(paint, this.fence, palette());
      },
      (paint) => {
        if (this.space) paint_space(paint, this.space, palette());
      },
      (paint) => {
        if (this.runs.length > 0) return;
        paint_route(paint, this.route.drawn, this.current_item);
        paint_way(paint, this.way);
      },
      (paint) => this.#paint_driven(paint),
      (paint) => {
        if (this.slips.length > 0) paint_slips(paint, this.slips, palette());
      },
      (paint) => this.#paint_edited(paint),
      (paint) => {
        if (this.drill) paint_drill(paint, this.drill, this.size, palette());
      },
      (paint) => {
        if (this.home) paint_home(paint, this.home, palette());
      },
      (paint) => {
        if (this.goal) paint_goal(paint, this.goal, this.robot?.at ?? null, palette());
      },
      (paint) => {
        if (this.pin) paint_pin(paint, this.pin, palette());
      },
      (paint) => {
        if (this.ahead) this.seen_painter?.paint_ahead(paint, this.ahead, palette());
        if (this.seen) this.seen_painter?.paint_seen(paint, this.seen, palette());
      },
      (paint) => {
        if (this.robot) paint_robot(paint, this.robot, this.size, palette());
      },
      (paint) => {
        if (this.ahead) this.seen_painter?.paint_block(paint, this.ahead, palette());
      },
      (paint) => {
        if (this.robot) paint_away(paint, this.robot, this.cover, palette());
      },
    ];
  }

  #paint_driven(paint: Paint): void {
    if (this.runs.length > 0) {
      paint_runs(paint, this.runs, palette());
      return;
    }
    this.fixes.paint_dots(paint, palette().fixes);
    this.driven.paint_line(paint, palette());
  }

  /** In the middle of a drag the line already goes where it will go. */
  #paint_edited(paint: Paint): void {
    const { drawn } = this.plan;
    const { drag } = this;
    const line =
      drag === null
        ? drawn.line
        : drag.what === 'spot'
          ? with_point(drawn.line, drag.k, drag.to)
          : with_inserted(drawn.line, drag.k, drag.to);
    const rings =
      drag?.what === 'handle' ? drawn.rings.map((ring) => ring_behind(ring, drag.k)) : drawn.rings;
    paint_plan(paint, drawn, line, rings, this.look);
  }
}
