// A block of rows that is planned: two taps, the first row's beginning and its end, and the rest as
// figures.

import type { Refusal } from '../model/answer';
import { bearing_deg, offset_from } from '../model/geo';
import type { Drawn, DrawnRows } from '../model/makings';
import type { LatLon, RowSide, Side } from '../model/plan';
import type { PlanningCalls } from '../model/ports';
import {
  drawn_block,
  ROW_TURNS,
  row_length_m,
  USUAL_ROW_M,
  why_not_rows,
  type RowBlock,
  type RowEntry,
  type RowsWish,
  type RowTurn,
} from '../model/row_block';
import type { RunOnMap } from '../model/run_ports';
import { row_refusal } from '../model/row_refusal';
import { say } from '../model/say';
import { robot_place } from '../model/vehicle';
import { Outline } from './drawing.svelte';
import type { Editor } from './editor.svelte';
import type { Live } from './live.svelte';
import type { Makings } from './makings.svelte';
import type { Notices } from './notices.svelte';
import { Planner } from './planner.svelte';

const RAD = Math.PI / 180;

/** Two places at most: a further tap moves the second one. */
export class FirstRow extends Outline {
  constructor() {
    super('line');
  }

  override add(at: LatLon): void {
    if (this.places.length < 2) super.add(at);
    else this.move(1, at);
  }

  override insert(_: number, at: LatLon): void {
    this.move(1, at);
  }
}

export class RowPlanner extends Planner<RowsWish, RowBlock> {
  /** Row 1 begins at a place; else where the robot stands when it starts. */
  by_place = $state(true);
  rows = $state(6);
  spacing_m = $state(2.5);
  turn = $state<Side>('right');
  skip = $state(0);
  out_m = $state(1.5);
  turn_kind = $state<RowTurn>('auto');
  radius_m = $state<number | null>(null);
  alternating = $state(true);
  /** Rows end at the latest where the first one was drawn to. */
  ends_there = $state(false);
  side = $state<RowSide>('both');
  gap_m = $state<number | null>(null);
  speed_mps = $state<number | null>(null);
  distance_m = $state<number | null>(null);
  seeing = $state<'line' | 'rays'>('line');
  readonly outline = new FirstRow();

  /** As it is tapped. */
  tapped = $derived.by((): RowEntry | null => {
    const [at, toward] = this.outline.places;
    if (!at || !toward) return null;
    // A finger is no finer than a hundredth of a degree.
    return { at, heading_deg: (Math.round(bearing_deg(at, toward) * 100) / 100) % 360 };
  });
  /** The rows are drawn so long. */
  length_m = $derived(row_length_m(this.distance_m, this.by_place ? this.outline.places : []));
  /** It drives by steering, and turns nowhere on the spot. */
  steers = $derived.by(() => this.#live.capabilities?.kinematics === 'ackermann');
  /** A turn of another kind that was kept stays to be seen. */
  turn_kinds = $derived(
    ROW_TURNS.filter((kind) => kind !== 'pivot' || !this.steers || this.turn_kind === 'pivot'),
  );
  /** There are arcs. */
  has_radius = $derived(this.turn_kind === 'auto' ? this.steers : this.turn_kind !== 'pivot');
  wish = $derived<RowsWish>({
    rows: this.rows,
    spacing_m: this.spacing_m,
    turn: this.turn,
    skip: this.skip,
    out_m: this.out_m,
    turn_kind: this.turn_kind,
    radius_m: this.has_radius ? this.radius_m : null,
    alternating: this.alternating,
    to: this.by_place && this.ends_there ? (this.outline.places[1] ?? null) : null,
    entry: this.by_place ? this.tapped : null,
    side: this.side,
    gap_m: this.side === 'both' ? null : this.gap_m,
    speed_mps: this.speed_mps,
    distance_m: this.distance_m,
    seeing: this.seeing,
  });
  why_not = $derived(why_not_rows(this.by_place, this.outline.places));
  drawn = $derived.by(() => {
    const entry = this.by_place ? this.tapped : this.#robot();
    return this.result && entry ? drawn_block(this.result.plan.items, entry, this.length_m) : null;
  });
  on_map = $derived<readonly RunOnMap[]>(
    this.drawn ? [{ lines: this.drawn.rows, planned: this.drawn.way }] : [],
  );
  readonly #live: Live;

  constructor(
    calls: PlanningCalls<RowsWish, RowBlock>,
    editor: Editor,
    notices: Notices,
    makings: Makings,
    live: Live,
  ) {
    super(calls, editor, notices, makings);
    this.#live = live;
    this.name = say('rows');
  }

  /** Row 1 begins where the robot stands now, and leads where it points. */
  take_robot(): void {
    const robot = this.#robot();
    if (!robot) return;
    this.outline.begin([robot.at]);
    this.outline.add(this.#along(robot, USUAL_ROW_M));
  }

  /** The first row in exactly this direction, as long as it is. */
  point_to(heading_deg: number): void {
    const [at] = this.outline.places;
    const long_m = row_length_m(null, this.outline.places);
    if (at) this.outline.add(this.#along({ at, heading_deg }, long_m));
  }

  /** Null: it does not know its place or where it points. */
  #robot(): RowEntry | null {
    const at = robot_place(this.#live.vehicle);
    const heading_deg = this.#live.robot?.heading_deg ?? null;
    return at && heading_deg !== null ? { at, heading_deg } : null;
  }

  #along({ at, heading_deg }: RowEntry, by_m: number): LatLon {
    const [east, north] = [Math.sin(heading_deg * RAD), Math.cos(heading_deg * RAD)];
    return offset_from(at, { east_m: by_m * east, north_m: by_m * north });
  }

  /** A block that is a mission already. @param id of the mission */
  change(id: string, { wish, places }: DrawnRows): void {
    this.outline.begin(places);
    this.by_place = wish.entry !== null;
    this.rows = wish.rows;
    this.spacing_m = wish.spacing_m;
    this.turn = wish.turn;
    this.skip = wish.skip;
    this.out_m = wish.out_m;
    // Those that were drawn before there was a choice turned on the spot, there and back.
    const kept: Partial<RowsWish> = wish;
    this.turn_kind = kept.turn_kind ?? 'auto';
    this.radius_m = kept.radius_m ?? null;
    this.alternating = kept.alternating ?? true;
    this.ends_there = (kept.to ?? null) !== null;
    this.side = wish.side;
    this.gap_m = wish.gap_m;
    this.speed_mps = wish.speed_mps;
    this.distance_m = wish.distance_m;
    this.seeing = wish.seeing;
    this.take_up(id);
  }

  protected drawn_now(): Drawn {
    return { kind: 'rows', wish: this.wish, places: this.outline.places };
  }

  protected override words_of(refusal: Refusal): string {
    return row_refusal(refusal);
  }

  protected clear(): void {
    this.outline.clear();
  }
}
