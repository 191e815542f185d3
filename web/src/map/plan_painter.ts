// Draws missions: the one being edited, with numbered points and handles, and the one the robot has
// loaded, as a quieter line. Numbers that would overlap become dots, so any size stays readable and
// cheap.

import { spots, type Plan, type Spot } from '../model/plan';
import type { PlanShape } from '../model/ports';
import { stroke_cased, trace, type Paint } from './canvas';
import { palette, type Palette } from './palette';
import {
  to_plane,
  to_plane_line,
  units_per_m,
  type PlaneLine,
  type PlanePoint,
} from './projection';

/** A plan ready to draw: projected once, when it changes. */
export interface DrawnPlan {
  readonly spots: readonly Spot[];
  readonly line: PlaneLine;
  /** Items without a place that follow each spot. */
  readonly chips: readonly number[];
  readonly rings: readonly Ring[];
}

/** A circle around a spot. */
export interface Ring {
  /** Of the spot. */
  readonly k: number;
  readonly radius_m: number;
  readonly clockwise: boolean;
  /** Whole circles; the area in which a loiter stays is no way. */
  readonly way: boolean;
  readonly units_per_m: number;
}

const POINT_PX = 14;
const WAY_PX = 2;
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
  return { spots: found, line: to_plane_line(found), chips, rings: rings_of(plan, found) };
};

const rings_of = (plan: Plan, found: readonly Spot[]): Ring[] =>
  found.flatMap((spot, k): Ring[] => {
    const item = plan.items[spot.index];
    const scale = units_per_m(spot.lat).east;
    if (item?.type === 'circle') {
      const { radius_m, clockwise } = item;
      return [{ k, radius_m, clockwise: clockwise === true, way: true, units_per_m: scale }];
    }
    if (item?.type !== 'loiter') return [];
    return [{ k, radius_m: item.radius_m ?? 1, clockwise: false, way: false, units_per_m: scale }];
  });

/** The line with one point elsewhere: what a drag will give. */
export const with_point = (line: PlaneLine, k: number, to: PlanePoint): PlaneLine => {
  const xs = line.xs.slice();
  const ys = line.ys.slice();
  xs[k] = to[0];
  ys[k] = to[1];
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

const disc = (context: CanvasRenderingContext2D, x: number, y: number, r: number): void => {
  context.beginPath();
  context.arc(x, y, r, 0, 2 * Math.PI);
};

const on_screen = (paint: Paint, x: number, y: number, margin: number): boolean =>
  x > -margin && y > -margin && x < paint.width_px + margin && y < paint.height_px + margin;

type Visit = (k: number, x: number, y: number) => void;

/** Calls for every segment longer than a length whose middle is on the screen. */
const long_segments = (paint: Paint, line: PlaneLine, from_px: number, visit: Visit): void => {
  for (let k = 1; k < line.xs.length; k += 1) {
    const x0 = paint.x_px(line.xs[k - 1] ?? 0);
    const y0 = paint.y_px(line.ys[k - 1] ?? 0);
    const x1 = paint.x_px(line.xs[k] ?? 0);
    const y1 = paint.y_px(line.ys[k] ?? 0);
    if (Math.hypot(x1 - x0, y1 - y0) < from_px) continue;
    const x = (x0 + x1) / 2;
    const y = (y0 + y1) / 2;
    if (on_screen(paint, x, y, 20)) visit(k, x, y);
  }
};

/** A small open arrow beside the middle of long segments: which way it goes. */
const paint_arrows = (paint: Paint, line: PlaneLine, color: string, share: number): void => {
  const { context } = paint;
  context.strokeStyle = color;
  context.lineWidth = 2.5;
  context.lineCap = 'round';
  context.beginPath();
  long_segments(paint, line, ARROW_FROM_PX, (k) => {
    const x0 = paint.x_px(line.xs[k - 1] ?? 0);
    const y0 = paint.y_px(line.ys[k - 1] ?? 0);
    const dx = paint.x_px(line.xs[k] ?? 0) - x0;
    const dy = paint.y_px(line.ys[k] ?? 0) - y0;
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

const paint_handles = (paint: Paint, line: PlaneLine, colors: Palette): void => {
  const { context } = paint;
  long_segments(paint, line, HANDLE_FROM_PX, (_, x, y) => {
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
  context.fillText(text, x, y + 0.5);
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

const paint_line = (paint: Paint, line: PlaneLine, look: PlanLook, colors: Palette): void => {
  const { context } = paint;
  context.beginPath();
  trace(paint, line.xs, line.ys);
  if (look.shape === 'ring') {
    context.closePath();
    context.fillStyle = colors.ring;
    context.fill();
  }
  stroke_cased(context, colors.casing, colors.plan, 3.5);
  if (look.shape === 'line') paint_arrows(paint, line, colors.plan, 0.36);
};

/** Circles with an arrow at three places that tells which way round. */
const paint_rings = (paint: Paint, drawn: DrawnPlan, line: PlaneLine, colors: Palette): void => {
  const { context } = paint;
  for (const ring of drawn.rings) {
    const x = paint.x_px(line.xs[ring.k] ?? 0);
    const y = paint.y_px(line.ys[ring.k] ?? 0);
    const r = (ring.radius_m * ring.units_per_m) / paint.resolution;
    if (!on_screen(paint, x, y, r + 20)) continue;
    disc(context, x, y, r);
    context.setLineDash(ring.way ? [] : [4, 5]);
    stroke_cased(context, colors.casing, colors.plan, ring.way ? 3.5 : 1.5);
    context.setLineDash([]);
    if (!ring.way || r < 15) continue;
    context.beginPath();
    for (const at of [0.5, 2.6, 4.7]) {
      // On the screen angles grow clockwise.
      const heading = at + (ring.clockwise ? Math.PI / 2 : -Math.PI / 2);
      const tip_x = x + r * Math.cos(at);
      const tip_y = y + r * Math.sin(at);
      for (const side of [2.5, -2.5]) {
        context.moveTo(tip_x, tip_y);
        context.lineTo(
          tip_x + 11 * Math.cos(heading + side),
          tip_y + 11 * Math.sin(heading + side),
        );
      }
    }
    stroke_cased(context, colors.casing, colors.plan, 3);
  }
};

/** @param line where the points are now: the drawn plan's own line, or one in the middle of a drag */
export const paint_plan = (
  paint: Paint,
  drawn: DrawnPlan,
  line: PlaneLine,
  look: PlanLook,
): void => {
  const colors = palette();
  if (look.shape !== 'points') {
    paint_line(paint, line, look, colors);
    if (look.handles) paint_handles(paint, line, colors);
  }
  if (line.xs.length === drawn.spots.length) {
    paint_rings(paint, drawn, line, colors);
    paint_points(paint, drawn, line, look);
  }
};

/** The loaded mission: what is done is faint, the item being driven to is marked. */
export const paint_route = (paint: Paint, drawn: DrawnPlan, current_item: number): void => {
  const colors = palette();
  const { context } = paint;
  const { xs, ys } = drawn.line;
  const next = drawn.spots.findIndex((spot) => spot.index + 1 >= current_item);
  const done = next < 0 ? xs.length : next;
  context.beginPath();
  trace(paint, xs, ys, 0, done);
  stroke_cased(context, colors.casing, colors.route_done, 9);
  context.beginPath();
  trace(paint, xs, ys, Math.max(0, done - 1));
  stroke_cased(context, colors.casing, colors.route, 9);
  const target = current_item > 0 ? drawn.spots[done] : undefined;
  if (!target) return;
  const [tx, ty] = to_plane(target);
  disc(context, paint.x_px(tx), paint.y_px(ty), POINT_PX + 9);
  stroke_cased(context, colors.casing, colors.current, 4.5);
};

/** How the loaded mission will be driven: corners rounded, dense points smoothed. */
export const paint_way = (paint: Paint, { xs, ys }: PlaneLine): void => {
  if (xs.length < 2) return;
  const { context } = paint;
  context.beginPath();
  trace(paint, xs, ys);
  context.strokeStyle = palette().way;
  context.lineWidth = WAY_PX;
  context.stroke();
};
