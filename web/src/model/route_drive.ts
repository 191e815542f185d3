// How the loaded mission is to be driven: how fast to each of its places, and where the robot turns on the
// spot. The robot tells it with the way that it laid (told_*). Until it has, it is worked out from the
// items: what is set is the most, and a turn is told only where the mission's own figures ask for one and
// the way as it is laid has a corner there.

import { circle_way } from './circle';
import { distance_m, type Offset } from './geo';
import type { WayPace, WayStop } from './laid_way';
import { plane_at } from './plane';
import { place_of, spots, type Circle, type Item, type LatLon, type Plan } from './plan';
import { speed_text, type SpeedUnit } from './settings';
import type { TrailShades } from './trail_shades';

/** Of the robot's parameters; null: not known. */
export interface SpeedsSet {
  /** Where the mission says nothing. */
  readonly default_mps: number | null;
  readonly min_mps: number | null;
  readonly max_mps: number | null;
  readonly reverse_max_mps: number | null;
}
export const NO_SPEEDS: SpeedsSet = {
  default_mps: null,
  min_mps: null,
  max_mps: null,
  reverse_max_mps: null,
};

/** To each place of the plan, in the order of its spots; null: not known. */
export const leg_speeds = (plan: Plan, set: SpeedsSet): (number | null)[] => {
  let running = plan.settings?.speed_mps ?? set.default_mps;
  return plan.items.flatMap((item) => {
    if (item.type === 'speed') running = item.speed_mps;
    if (place_of(item) === null) return [];
    const own = item.type === 'waypoint' || item.type === 'circle' ? item.speed_mps : null;
    const wanted = own ?? running;
    const backwards = item.type === 'waypoint' && item.reverse === true;
    const most = backwards ? set.reverse_max_mps : set.max_mps;
    if (wanted === null || most === null || set.min_mps === null) return [null];
    return [Math.min(Math.max(wanted, set.min_mps), most)];
  });
};

/** A speed to be written on the map: on the way to a spot. */
export interface SpeedTag {
  /** Of the spot. */
  readonly k: number;
  readonly text: string;
}

/** As short as it is exact to a hundredth. */
const tag_text = (speed: number, unit: SpeedUnit): string => {
  const tenths = unit === 'm/s' && Math.abs(Math.round(10 * speed) - 10 * speed) < 0.05;
  return speed_text(speed, unit, tenths ? 1 : 2);
};

/** Where another speed begins; none of a mission that has one. */
export const speed_tags = (speeds: readonly (number | null)[], unit: SpeedUnit): SpeedTag[] => {
  // Nobody drives a way to the first place that is on the map; its speed is seen on the one behind it.
  const legs = speeds.slice(1);
  if (new Set(legs).size < 2) return [];
  return legs.flatMap((speed, n) =>
    speed === null || (n > 0 && legs[n - 1] === speed)
      ? []
      : [{ k: n + 1, text: tag_text(speed, unit) }],
  );
};

/** A place at which the robot turns on the spot. */
export interface Pivot extends LatLon {
  /** Of the item that is there. */
  readonly index: number;
  readonly left: boolean;
  /** To the outside of the corner, radians counter-clockwise from the east. */
  readonly outside_rad: number;
}

/** What of it is shown. */
export interface DriveOnMap {
  /** To each spot of the plan; null: not known. */
  readonly speeds: readonly (number | null)[];
  readonly tags: readonly SpeedTag[];
  readonly pivots: readonly Pivot[];
  /** Along the way as it is laid, planned; empty: not known. */
  readonly pace: readonly WayPace[];
  /** Of the way ahead; null: one colour. */
  readonly shades: TrailShades | null;
}
export interface Turning {
  /** As the capabilities name it. */
  readonly kinematics: string;
  readonly pivot_angle_deg: number;
}

const DEG = Math.PI / 180;
/** A corner that asks for it is turned when it is more than this. */
const ASKED_RAD = 5 * DEG;
/** Sharper than this nothing is rounded. */
const ARC_MOST_RAD = 150 * DEG;
/** Between a corner of the mission and of the way as it is laid: a circle's is laid in chords. */
const ALIKE_RAD = 15 * DEG;
const NEAR_M = 0.05;
/** Nearer to a circle there is no tangent to drive. */
const ON_M = 0.2;

const wrapped = (rad: number): number => Math.atan2(Math.sin(rad), Math.cos(rad));

/** Corners of the way as it is laid, found by where they are. */
class Laid {
  readonly #by_cell = new Map<string, { readonly at: LatLon; readonly turn_rad: number }[]>();

  constructor(way: readonly LatLon[]) {
    for (let k = 1; k + 1 < way.length; k += 1) {
      const [before, at, after] = [way[k - 1], way[k], way[k + 1]];
      if (!before || !at || !after) continue;
      const plane = plane_at(at);
      const [a, b] = [plane.to_plane(before), plane.to_plane(after)];
      const turn_rad = wrapped(Math.atan2(b.north_m, b.east_m) - Math.atan2(-a.north_m, -a.east_m));
      const cell = this.#cell(at);
      this.#by_cell.set(cell, [...(this.#by_cell.get(cell) ?? []), { at, turn_rad }]);
    }
  }

  has(at: LatLon, turn_rad: number): boolean {
    for (const north of [-1, 0, 1]) {
      for (const east of [-1, 0, 1]) {
        const found = this.#by_cell.get(this.#cell(at, north, east)) ?? [];
        const alike = found.some(
          (corner) =>
            distance_m(corner.at, at) < NEAR_M &&
            Math.abs(wrapped(corner.turn_rad - turn_rad)) < ALIKE_RAD,
        );
        if (alike) return true;
      }
    }
    return false;
  }

  /** Of a millionth of a degree: as wide as what counts as near, or wider, up to 60 degrees north. */
  #cell({ lat, lon }: LatLon, north = 0, east = 0): string {
    return `${Math.round(lat * 1e6) + north} ${Math.round(lon * 1e6) + east}`;
  }
}

/** Where the robot is in the plan, and how it points there; null: a plan does not tell. */
interface Stand {
  readonly at: Offset;
  readonly index: number;
  /** Which way it came. */
  readonly course_rad: number | null;
  /** Which way it faces. */
  readonly yaw_rad: number | null;
  /** More than this it turns on the spot before it goes on. */
  readonly from_rad: number;
}

const from_rad_of = (item: Item, auto_rad: number): number => {
  if (item.type !== 'waypoint') return auto_rad;
  if (item.turn === 'pivot') return ASKED_RAD;
  return item.turn === 'arc' || item.turn === 'through' ? ARC_MOST_RAD : auto_rad;
};

const on_circle = (centre: Offset, radius_m: number, angle_rad: number): Offset => ({
  east_m: centre.east_m + radius_m * Math.cos(angle_rad),
  north_m: centre.north_m + radius_m * Math.sin(angle_rad),
});

const ring_of = (item: Circle, centre: Offset, before: Offset | null) => {
  const { from_rad, sweep_rad } = circle_way(
    {
      radius: item.radius_m,
      clockwise: item.clockwise === true,
      turns: item.turns ?? 1,
      on: ON_M,
    },
    before && [before.east_m - centre.east_m, before.north_m - centre.north_m],
  );
  const tangent_rad = (at_rad: number): number => at_rad + (Math.sign(sweep_rad) * Math.PI) / 2;
  const end_rad = from_rad + sweep_rad;
  return {
    entry: on_circle(centre, item.radius_m, from_rad),
    entry_rad: tangent_rad(from_rad),
    exit: on_circle(centre, item.radius_m, end_rad),
    exit_rad: tangent_rad(end_rad),
  };
};

/** Walks through the plan and notes where it turns. */
class Walk {
  readonly found: Pivot[] = [];
  readonly #plane: ReturnType<typeof plane_at>;
  readonly #laid: Laid;
  readonly #auto_rad: number;
  #stand: Stand | null = null;

  constructor(origin: LatLon, way: readonly LatLon[], pivot_angle_deg: number) {
    this.#plane = plane_at(origin);
    this.#laid = new Laid(way);
    this.#auto_rad = pivot_angle_deg * DEG;
  }

  take(item: Item, index: number): void {
    const place = place_of(item);
    if (place) this.#go(item, index, this.#plane.to_plane(place));
    else if (item.type === 'turn' && !item.radius_m)
      this.#turn(item.turn_deg ?? null, item.heading_deg ?? null);
    else if (item.type !== 'speed' && item.type !== 'wait' && item.type !== 'action') {
      this.#stand = null;
    }
  }

  #go(item: Item, index: number, to: Offset): void {
    const last = this.#stand;
    const ring = item.type === 'circle' ? ring_of(item, to, last?.at ?? null) : null;
    const entry = ring?.entry ?? to;
    const way = last && {
      east_m: entry.east_m - last.at.east_m,
      north_m: entry.north_m - last.at.north_m,
    };
    const moves = way !== null && Math.hypot(way.east_m, way.north_m) > 0;
    const course_rad = moves ? Math.atan2(way.north_m, way.east_m) : (last?.course_rad ?? null);
    const backwards = item.type === 'waypoint' && item.reverse === true;
    const yaw_rad = moves && course_rad !== null ? course_rad + (backwards ? Math.PI : 0) : null;
    if (last && yaw_rad !== null && course_rad !== null) this.#leave(last, course_rad, yaw_rad);
    const from_rad = from_rad_of(item, this.#auto_rad);
    const stand = { at: entry, index, course_rad, yaw_rad: yaw_rad ?? last?.yaw_rad ?? null };
    this.#stand = { ...stand, from_rad };
    if (!ring) return;
    if (course_rad !== null) this.#leave(this.#stand, ring.entry_rad, ring.entry_rad);
    const out = { at: ring.exit, course_rad: ring.exit_rad, yaw_rad: ring.exit_rad };
    this.#stand = { ...out, index, from_rad };
  }

  #leave(last: Stand, course_rad: number, yaw_rad: number): void {
    if (last.yaw_rad === null || last.course_rad === null) return;
    const turn_rad = wrapped(yaw_rad - last.yaw_rad);
    if (Math.abs(turn_rad) <= last.from_rad) return;
    const at = this.#plane.from_plane(last.at);
    if (!this.#laid.has(at, wrapped(course_rad - last.course_rad))) return;
    this.#note(last, turn_rad > 0, course_rad);
  }

  /** An item that turns: it does so wherever the way goes on to. */
  #turn(turn_deg: number | null, heading_deg: number | null): void {
    const last = this.#stand;
    if (!last || last.yaw_rad === null) return;
    const yaw_rad =
      turn_deg !== null ? last.yaw_rad - turn_deg * DEG : Math.PI / 2 - (heading_deg ?? 0) * DEG;
    const left = turn_deg !== null ? turn_deg < 0 : wrapped(yaw_rad - last.yaw_rad) > 0;
    if (Math.abs(turn_deg ?? 360) > 0) this.#note(last, left, null);
    this.#stand = { ...last, yaw_rad };
  }

  /** One mark for each place. @param course_rad on which it goes on; null: not known */
  #note(last: Stand, left: boolean, course_rad: number | null): void {
    const known = this.found[this.found.length - 1];
    const at = this.#plane.from_plane(last.at);
    if (known?.index === last.index && distance_m(known, at) < NEAR_M) return;
    const [x, y] = [Math.cos(last.course_rad ?? 0), Math.sin(last.course_rad ?? 0)];
    const on = course_rad === null ? [0, 0] : [Math.cos(course_rad), Math.sin(course_rad)];
    const outside_rad = Math.atan2(y - (on[1] ?? 0), x - (on[0] ?? 0));
    this.found.push({ ...at, index: last.index, left, outside_rad });
  }
}

/**
 * Where the robot turns on the spot, as far as mission and laid way tell: not where it begins, nor
 * behind what has no place, nor at the stations of a circle.
 * @param way as the robot laid it; empty: not known, and nothing is told
 */
export const pivots_of = (
  plan: Plan,
  way: readonly LatLon[],
  { kinematics, pivot_angle_deg }: Turning,
): readonly Pivot[] => {
  const [origin] = spots(plan);
  if (kinematics === 'ackermann' || way.length === 0 || !origin) return [];
  const walk = new Walk(origin, way, pivot_angle_deg);
  plan.items.forEach((item, index) => walk.take(item, index));
  return walk.found;
};

/** The ones that are still to come. @param current_item from 1; 0: none is in hand */
export const pivots_ahead = (pivots: readonly Pivot[], current_item: number): readonly Pivot[] =>
  pivots.filter(({ index }) => index + 1 >= current_item);

/** As leg_speeds, by what the robot laid: what vehicle and bends leave of it, too. */
export const told_speeds = (
  plan: Plan,
  set: SpeedsSet,
  pace: readonly WayPace[],
): (number | null)[] => {
  const most = new Map<number, number>();
  pace.slice(0, -1).forEach(({ item, set_mps }) => {
    most.set(item, Math.max(most.get(item) ?? 0, set_mps));
  });
  const own = leg_speeds(plan, set);
  return spots(plan).map(({ index }, k) => most.get(index + 1) ?? own[k] ?? null);
};

/** Nearer than this the robot stands where its way begins. */
const AT_BEGIN_M = 1;
/** So coarse is its heading told: it trembles. */
const HEADING_STEP_DEG = 10;

/**
 * How the robot points where its way begins, in steps of 10 degrees.
 * @return null: it stands elsewhere, and nobody knows how it will come there
 */
export const begin_heading = (
  stops: readonly WayStop[],
  at: (LatLon & { readonly heading_deg: number | null }) | null,
): number | null => {
  const [begin] = stops;
  if (!begin || !at || at.heading_deg === null || distance_m(begin, at) > AT_BEGIN_M) return null;
  return (HEADING_STEP_DEG * Math.round(at.heading_deg / HEADING_STEP_DEG)) % 360;
};

/** The way that it goes past a place of it, radians counter-clockwise from the east. */
const course_at = (pace: readonly WayPace[], from: number, to: number): number | null => {
  const [a, b] = [pace[from], pace[to]];
  if (!a || !b) return null;
  const { east_m, north_m } = plane_at(a).to_plane(b);
  return Math.atan2(north_m, east_m);
};

/** The first place of the pace that is not before it. */
const place_in = (pace: readonly WayPace[], at_m: number): number => {
  let [low, high] = [0, pace.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((pace[middle]?.distance_m ?? 0) < at_m - NEAR_M) low = middle + 1;
    else high = middle;
  }
  return low;
};

const shortest_deg = (from: number, to: number): number => wrapped((to - from) * DEG) / DEG;

/**
 * As pivots_of, by what the robot laid: one for each stop at which it turns.
 * @param begin_deg how it points where the way begins; null: not known
 */
export const told_pivots = (
  stops: readonly WayStop[],
  pace: readonly WayPace[],
  begin_deg: number | null,
): readonly Pivot[] =>
  stops.flatMap((stop, n): Pivot[] => {
    const [turn] = stop.turns.flatMap(({ turn_deg, to_heading_deg, above_deg }) => {
      if (turn_deg !== null) return [turn_deg];
      if (n > 0 || begin_deg === null) return [];
      const by = shortest_deg(begin_deg, to_heading_deg);
      return Math.abs(by) > above_deg ? [by] : [];
    });
    if (turn === undefined) return [];
    const k = place_in(pace, stop.distance_m);
    const into = course_at(pace, k - 1, k);
    const on = course_at(pace, k, k + 1);
    const [x, y] = into === null ? [0, 0] : [Math.cos(into), Math.sin(into)];
    const [u, v] = on === null ? [0, 0] : [Math.cos(on), Math.sin(on)];
    const { lat, lon } = stop;
    const outside_rad = Math.atan2(y - v, x - u);
    return [{ lat, lon, index: stop.item - 1, left: turn < 0, outside_rad }];
  });
