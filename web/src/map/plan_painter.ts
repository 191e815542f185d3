// Draws the mission that is edited, with numbered points and handles. Numbers that would overlap become
// dots, so any size stays readable and cheap.

import { spots, type Plan, type Spot } from '../model/plan';
import type { PlanShape } from '../model/ports';
import { band_of, leg, rings_of, type Band, type Ring } from './band';
import { stand_at, stroke_cased, trace, trace_open, type Paint } from './canvas';
import { palette, type Palette } from './palette';
import { to_plane_line, type PlaneLine, type PlanePoint } from './projection';
import { paint_ring_arrows, paint_ring_line } from './ring_painter';

/** A plan ready to draw: projected once, when it changes. */
export interface DrawnPlan {
  readonly spots: readonly Spot[];
  readonly line: PlaneLine;
  /** Items without a place that follow each spot. */
  readonly chips: readonly number[];
  readonly rings: readonly Ring[];
  /** Spots that are come to backwards. */
  readonly backwards: readonly number[];
  /** As the line is driven. */
  readonly band: Band;
}

export const POINT_PX = 14;
const NUMBERS_APART_PX = 33;
/** With more points in sight than this, only some numbers are drawn. */
const CROWD = 150;
const CROWDED_APART_PX = 90;
const DOTS_APART_PX = 9;
/** Segments shorter than this have no handle for a new point in their middle. */
export const HANDLE_FROM_PX = 72;
const ARROW_FROM_PX = 110;

export const prepare_plan = (plan: Plan): DrawnPlan => {
  const found = spots(plan);
  const chips = found.map((spot, k) => (found[k + 1]?.index ?? plan.items.length) - spot.index - 1);
  const line = to_plane_line(found);
  const rings = rings_of(plan, found);
  const backwards = found.flatMap(({ index }, k) => {
    const item = plan.items[index];
    return item?.type === 'waypoint' && item.reverse === true ? [k] : [];
  });
  return { spots: found, line, chips, rings, backwards, band: band_of(line, rings) };
};

/** A plan, projected once: when it changes. */
export class ProjectedPlan {
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

/** The line with one point elsewhere: what a drag will give. */
export const with_point = (line: PlaneLine, k: number, to: PlanePoint): PlaneLine => {
  const xs = line.xs.slice();
  const ys = line.ys.slice();
  xs[k] = to[0];
  ys[k] = to[1];
  return { xs, ys };
};

/** The line with some points moved as one of them is. */
export const with_moved = (
  line: PlaneLine,
  ks: readonly number[],
  { k: taken, to }: { readonly k: number; readonly to: PlanePoint },
): PlaneLine => {
  const xs = line.xs.slice();
  const ys = line.ys.slice();
  const [dx, dy] = [to[0] - (line.xs[taken] ?? 0), to[1] - (line.ys[taken] ?? 0)];
  for (const k of ks) {
    xs[k] = (xs[k] ?? 0) + dx;
    ys[k] = (ys[k] ?? 0) + dy;
  }
  return { xs, ys };
};

/** The line with one more point before point `k`. */
export const with_inserted = (line: PlaneLine, k: number, at: PlanePoint): PlaneLine => {
  const column = (old: Float64Array, value: number): Float64Array => {
    const longer = new Float64Array(old.length + 1);
    longer.set(old.subarray(0, k));
    longer[k] = value;
    longer.set(old.subarray(k), k + 1);
    return longer;
  };
  return { xs: column(line.xs, at[0]), ys: column(line.ys, at[1]) };
};

/** The plan without what is before one spot, or from another one on. */
export const part_of = (drawn: DrawnPlan, first: number, end: number): DrawnPlan => {
  const { line } = drawn;
  const part = { xs: line.xs.slice(first, end), ys: line.ys.slice(first, end) };
  const rings = drawn.rings
    .filter(({ k }) => k >= first && k < end)
    .map((ring) => ({
      ...ring,
      k: ring.k - first,
      // The spot before it is in another part.
      before: ring.before === 'spot' && ring.k === first ? null : ring.before,
    }));
  const band = band_of(part, rings);
  return {
    spots: drawn.spots.slice(first, end),
    chips: drawn.chips.slice(first, end),
    line: part,
    rings,
    backwards: drawn.backwards.filter((k) => k >= first && k < end).map((k) => k - first),
    band,
  };
};

export const disc = (context: CanvasRenderingContext2D, x: number, y: number, r: number): void => {
  context.beginPath();
  context.arc(x, y, r, 0, 2 * Math.PI);
};

const on_screen = (paint: Paint, x: number, y: number, margin: number): boolean =>
  x > -margin && y > -margin && x < paint.width_px + margin && y < paint.height_px + margin;

type Visit = (k: number, x: number, y: number) => void;

/** Calls for every way between spots longer than a length whose middle is on the screen. */
const long_legs = (paint: Paint, band: Band, from_px: number, visit: Visit): void => {
  for (let k = 1; k < band.begin.length; k += 1) {
    const [[from_x, from_y], [to_x, to_y]] = leg(band, k);
    const x0 = paint.x_px(from_x);
    const y0 = paint.y_px(from_y);
    const x1 = paint.x_px(to_x);
    const y1 = paint.y_px(to_y);
    if (Math.hypot(x1 - x0, y1 - y0) < from_px) continue;
    const x = (x0 + x1) / 2;
    const y = (y0 + y1) / 2;
    if (on_screen(paint, x, y, 20)) visit(k, x, y);
  }
};

/** A small open arrow beside the middle of long segments: which way it goes. */
export const paint_arrows = (paint: Paint, band: Band, color: string, share: number): void => {
  const { context } = paint;
  context.strokeStyle = color;
  context.lineWidth = 2.5;
  context.lineCap = 'round';
  context.beginPath();
  long_legs(paint, band, ARROW_FROM_PX, (k) => {
    const [from, to] = leg(band, k);
    const x0 = paint.x_px(from[0]);
    const y0 = paint.y_px(from[1]);
    const dx = paint.x_px(to[0]) - x0;
    const dy = paint.y_px(to[1]) - y0;
    const angle = Math.atan2(dy, dx);
    const x = x0 + dx * share;
    const y = y0 + dy * share;
    for (const side of [2.5, -2.5]) {
      context.moveTo(x, y);
      context.lineTo(x + 10 * Math.cos(angle + side), y + 10 * Math.sin(angle + side));
    }
  });
  context.stroke();
};

/** What is driven backwards is dashed, inside of its line. */
export const paint_backwards = (
  paint: Paint,
  { band, backwards }: DrawnPlan,
  color: string,
): void => {
  if (backwards.length === 0) return;
  const { context } = paint;
  context.save();
  context.beginPath();
  for (const k of backwards) {
    if (k === 0) continue; // from wherever the robot stands
    const [from, to] = leg(band, k);
    context.moveTo(paint.x_px(from[0]), paint.y_px(from[1]));
    context.lineTo(paint.x_px(to[0]), paint.y_px(to[1]));
  }
  context.setLineDash([6, 8]);
  context.strokeStyle = color;
  context.lineWidth = 2.5;
  context.stroke();
  context.restore();
};

const paint_handles = (paint: Paint, band: Band, colors: Palette): void => {
  const { context } = paint;
  long_legs(paint, band, HANDLE_FROM_PX, (_, x, y) => {
    disc(context, x, y, 9);
    context.fillStyle = colors.ground;
    context.fill();
    context.strokeStyle = colors.plan;
    context.lineWidth = 2;
    context.stroke();
    context.beginPath();
    context.moveTo(x - 4.5, y);
    context.lineTo(x + 4.5, y);
    context.moveTo(x, y - 4.5);
    context.lineTo(x, y + 4.5);
    context.stroke();
  });
};

interface PointStyle {
  readonly fill: string;
  readonly ink: string;
  readonly casing: string;
  readonly radius_px: number;
}

const paint_point = (paint: Paint, x: number, y: number, text: string, style: PointStyle): void => {
  const { context } = paint;
  disc(context, x, y, style.radius_px + 2);
  context.fillStyle = style.casing;
  context.fill();
  disc(context, x, y, style.radius_px);
  context.fillStyle = style.fill;
  context.fill();
  context.fillStyle = style.ink;
  context.font = `700 ${text.length > 3 ? 9 : text.length > 2 ? 11 : 13}px system-ui, sans-serif`;
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.save();
  stand_at(paint, x, y);
  context.fillText(text, 0, 0.5);
  context.restore();
};

/** Places on the screen that are taken, each with free room around it. */
class Room {
  readonly #taken = new Map<number, PlanePoint>();
  readonly #apart_px: number;

  constructor(apart_px: number) {
    this.#apart_px = apart_px;
  }

  /** @return false: something is nearer than allowed */
  take(x: number, y: number): boolean {
    const column = Math.floor(x / this.#apart_px);
    const row = Math.floor(y / this.#apart_px);
    for (let c = column - 1; c <= column + 1; c += 1) {
      for (let r = row - 1; r <= row + 1; r += 1) {
        const other = this.#taken.get(c * 100_003 + r);
        if (other && Math.hypot(other[0] - x, other[1] - y) < this.#apart_px) return false;
      }
    }
    this.#taken.set(column * 100_003 + row, [x, y]);
    return true;
  }
}

export interface PlanLook {
  readonly selected: number | null;
  readonly refused: ReadonlySet<number>;
  readonly handles: boolean;
  /** It is not what the robot drives, or will drive. */
  readonly faint: boolean;
  readonly shape: PlanShape;
}

/** Spots in the order in which they may claim room: the chosen one, refused ones, then by number. */
const by_claim = function* (drawn: DrawnPlan, look: PlanLook): Generator<number> {
  const special = new Set<number>();
  drawn.spots.forEach(({ index }, k) => {
    if (index === look.selected) special.add(k);
  });
  drawn.spots.forEach(({ index }, k) => {
    if (look.refused.has(index)) special.add(k);
  });
  yield* special;
  for (let k = 0; k < drawn.spots.length; k += 1) if (!special.has(k)) yield k;
};

const paint_spot = (
  paint: Paint,
  [x, y]: PlanePoint,
  index: number,
  chips: number,
  look: PlanLook,
): void => {
  const colors = palette();
  const chosen = index === look.selected;
  const point = { ink: colors.on_point, casing: colors.casing };
  paint_point(paint, x, y, String(index + 1), {
    ...point,
    fill: look.refused.has(index) ? colors.refused : chosen ? colors.selected : colors.plan,
    radius_px: chosen ? POINT_PX + 3 : POINT_PX,
  });
  if (chips > 0) {
    paint_point(paint, x + 15, y - 13, `+${chips}`, { ...point, fill: colors.home, radius_px: 8 });
  }
};

const paint_points = (paint: Paint, drawn: DrawnPlan, line: PlaneLine, look: PlanLook): void => {
  const { context } = paint;
  const x_of = (k: number): number => paint.x_px(line.xs[k] ?? 0);
  const y_of = (k: number): number => paint.y_px(line.ys[k] ?? 0);
  const seen = [...by_claim(drawn, look)].filter((k) => on_screen(paint, x_of(k), y_of(k), 30));
  const numbers = new Room(seen.length > CROWD ? CROWDED_APART_PX : NUMBERS_APART_PX);
  const dots = new Room(DOTS_APART_PX);
  const numbered: number[] = [];
  context.beginPath();
  for (const k of seen) {
    const x = x_of(k);
    const y = y_of(k);
    if (numbers.take(x, y)) numbered.push(k);
    else if (dots.take(x, y)) context.rect(x - 2.5, y - 2.5, 5, 5);
  }
  context.fillStyle = palette().plan;
  context.fill();
  for (const k of numbered.reverse()) {
    const index = drawn.spots[k]?.index ?? 0;
    paint_spot(paint, [x_of(k), y_of(k)], index, drawn.chips[k] ?? 0, look);
  }
};

const paint_line = (paint: Paint, band: Band, look: PlanLook, colors: Palette): void => {
  const { context } = paint;
  context.beginPath();
  if (look.shape === 'ring') {
    trace(paint, band.line.xs, band.line.ys);
    context.closePath();
    context.fillStyle = colors.ring;
    context.fill();
  } else trace_open(paint, band.line.xs, band.line.ys);
  stroke_cased(context, colors.casing, colors.plan, 3.5);
  if (look.shape === 'line') paint_arrows(paint, band, colors.plan, 0.36);
};

/** Calls for every ring in sight. */
const each_ring = (
  paint: Paint,
  rings: readonly Ring[],
  line: PlaneLine,
  visit: typeof paint_ring_line,
): void => {
  const { plan, casing } = palette();
  for (const ring of rings) {
    const x = paint.x_px(line.xs[ring.k] ?? 0);
    const y = paint.y_px(line.ys[ring.k] ?? 0);
    const r = (ring.radius_m * ring.units_per_m) / paint.resolution;
    if (!on_screen(paint, x, y, r + 20)) continue;
    const clockwise = ring.way ? ring.clockwise : null;
    visit(paint, x, y, r, { clockwise, line_px: null, color: plan, casing });
  }
};

/**
 * @param line where the points are now: the drawn plan's own line, or one in the middle of a drag
 * @param rings of that line
 */
export const paint_plan = (
  paint: Paint,
  drawn: DrawnPlan,
  line: PlaneLine,
  rings: readonly Ring[],
  look: PlanLook,
): void => {
  const colors = palette();
  const still = line === drawn.line;
  // What is driven of them is part of the line, and the arrows stand on it.
  each_ring(paint, rings, line, paint_ring_line);
  if (look.shape !== 'points') {
    const band = still ? drawn.band : band_of(line, rings);
    paint_line(paint, band, look, colors);
    if (look.shape === 'line') paint_backwards(paint, { ...drawn, band }, colors.casing);
    if (look.handles) paint_handles(paint, band, colors);
  }
  each_ring(paint, rings, line, paint_ring_arrows);
  if (line.xs.length === drawn.spots.length) paint_points(paint, drawn, line, look);
};
