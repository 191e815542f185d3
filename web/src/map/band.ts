// The line through the places of a plan as it is driven: to a circle along its tangent, around it, and
// on from where its turns end; never through its centre.

import { circle_way, type CircleWay } from '../model/circle';
import { place_of, type Plan, type Spot } from '../model/plan';
import { to_plane, units_per_m, type PlaneLine, type PlanePoint } from './projection';

/** A circle around a spot. */
export interface Ring {
  /** Of the spot. */
  readonly k: number;
  readonly radius_m: number;
  readonly clockwise: boolean;
  /** Whole circles; the area in which a loiter stays is no way. */
  readonly way: boolean;
  readonly turns: number;
  /** From where it is driven to; null: a plan does not tell. */
  readonly before: 'spot' | PlanePoint | null;
  readonly units_per_m: number;
}

export interface Band {
  readonly line: PlaneLine;
  /** Of each spot: where the line comes to it, and where it leaves. */
  readonly begin: Int32Array;
  readonly end: Int32Array;
}

/** Nearer to a circle there is no tangent to drive. */
const ON_M = 0.2;
const PIECE_RAD = Math.PI / 36;

/** From where the item is driven to. @param index of the item; @param last the spot before it */
const before_of = (plan: Plan, index: number, last: Spot | undefined): Ring['before'] => {
  for (let i = index - 1; i > (last?.index ?? -1); i -= 1) {
    const type = plan.items[i]?.type;
    const elsewhere = type === 'move' || type === 'return_home' || type === 'jump';
    if (elsewhere || type === 'local' || type === 'loiter') return null;
  }
  if (last) return 'spot';
  return plan.home ? to_plane(plan.home) : null;
};

export const rings_of = (plan: Plan, found: readonly Spot[]): Ring[] =>
  found.flatMap((spot, k): Ring[] => {
    const item = plan.items[spot.index];
    if (item?.type !== 'circle' && item?.type !== 'loiter') return [];
    if (place_of(item) === null) return [];
    const ring = { k, units_per_m: units_per_m(spot.lat).east };
    if (item.type === 'circle') {
      const { radius_m } = item;
      const before = before_of(plan, spot.index, found[k - 1]);
      const turned = { clockwise: item.clockwise === true, turns: item.turns ?? 1 };
      return [{ ...ring, ...turned, radius_m, way: true, before }];
    }
    const stays = { way: false, clockwise: false, turns: 1, before: null };
    return [{ ...ring, ...stays, radius_m: item.radius_m ?? 1 }];
  });

/** The ring after a point was put before point `k`. */
export const ring_behind = (ring: Ring, k: number): Ring =>
  ring.k < k ? ring : { ...ring, k: ring.k + 1 };

const relative = (from: PlanePoint, centre: PlanePoint): PlanePoint => [
  from[0] - centre[0],
  from[1] - centre[1],
];

export const way_of_ring = (
  { radius_m, clockwise, turns, units_per_m: scale }: Ring,
  centre: PlanePoint,
  before: PlanePoint | null,
): CircleWay =>
  circle_way(
    { radius: radius_m * scale, clockwise, turns, on: ON_M * scale },
    before && relative(before, centre),
  );

/** What is seen of its way: one whole turn at most, and what comes after the last whole one. */
const arc = (ring: Ring, centre: PlanePoint, way: CircleWay): PlanePoint[] => {
  const whole = Math.floor(ring.turns + 1e-9);
  const turns = whole < 1 ? ring.turns : 1 + ring.turns - whole;
  const sweep = Math.sign(way.sweep_rad) * 2 * Math.PI * turns;
  const pieces = Math.max(1, Math.ceil(Math.abs(sweep) / PIECE_RAD));
  const radius = ring.radius_m * ring.units_per_m;
  return Array.from({ length: pieces + 1 }, (_, i): PlanePoint => {
    const angle = way.from_rad + (sweep * i) / pieces;
    return [centre[0] + radius * Math.cos(angle), centre[1] + radius * Math.sin(angle)];
  });
};

/** @param line through the spots */
export const band_of = (line: PlaneLine, rings: readonly Ring[]): Band => {
  const count = line.xs.length;
  const begin = Int32Array.from({ length: count }, (_, k) => k);
  const ways = rings.filter(({ way }) => way);
  if (ways.length === 0) return { line, begin, end: begin };
  const by_spot = new Map(ways.map((ring) => [ring.k, ring]));
  const end = new Int32Array(count);
  const xs: number[] = [];
  const ys: number[] = [];
  for (let k = 0; k < count; k += 1) {
    const place: PlanePoint = [line.xs[k] ?? 0, line.ys[k] ?? 0];
    const ring = by_spot.get(k);
    const last: PlanePoint | null =
      xs.length > 0 ? [xs[xs.length - 1] ?? 0, ys[ys.length - 1] ?? 0] : null;
    const before = ring?.before === 'spot' ? last : (ring?.before ?? null);
    const points = ring ? arc(ring, place, way_of_ring(ring, place, before)) : [place];
    begin[k] = xs.length;
    for (const [x, y] of points) {
      xs.push(x);
      ys.push(y);
    }
    end[k] = xs.length - 1;
  }
  return { line: { xs: Float64Array.from(xs), ys: Float64Array.from(ys) }, begin, end };
};

/** The way from the spot before to spot `k`, from 1. */
export const leg = ({ line, begin, end }: Band, k: number): readonly [PlanePoint, PlanePoint] => {
  const from = end[k - 1] ?? 0;
  const to = begin[k] ?? 0;
  return [
    [line.xs[from] ?? 0, line.ys[from] ?? 0],
    [line.xs[to] ?? 0, line.ys[to] ?? 0],
  ];
};
