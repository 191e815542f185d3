// The chosen items as a figure: moved, turned, scaled, mirrored, made straight, laid beside itself.
// As on the robot: headings turn with the figure, a straight move grows with it, a mirror changes
// left and right.

import type { PlanAction } from './actions';
import type { Offset } from './geo';
import { offset_between } from './geo';
import { plane_at } from './plane';
import { place_of, type Item, type LatLon, type Plan } from './plan';
import { middle_of, picked_spots, with_followers, type Picked } from './selection';

const RAD = Math.PI / 180;
const FULL_DEG = 360;

const compass = (deg: number): number => {
  const turned = ((deg % FULL_DEG) + FULL_DEG) % FULL_DEG;
  return Math.round(turned * 1e6) / 1e6;
};

const at_place = (item: Item, at: LatLon): Item => ({ ...item, ...at }) as Item;

/** A row or a wall that ends beside a place goes on ending there, wherever that goes. */
const with_end = (item: Item, moved: (at: LatLon) => LatLon): Item => {
  if (item.type !== 'row' && item.type !== 'wall') return item;
  const { until_lat: lat, until_lon: lon } = item;
  if (typeof lat !== 'number' || typeof lon !== 'number') return item;
  const to = moved({ lat, lon });
  return { ...item, until_lat: to.lat, until_lon: to.lon };
};

/** What becomes of the places, and of what has a direction or a length of its own. */
interface Change {
  readonly place: (offset: Offset) => Offset;
  readonly item: (item: Item) => Item;
}

/** @param about null: the middle of the chosen ones */
const as_figure =
  (picked: Picked, about: LatLon | null, { place, item: change }: Change): PlanAction =>
  (plan) => {
    const origin = about ?? middle_of(picked_spots(plan, picked));
    if (!origin) return plan;
    const plane = plane_at(origin);
    const moved = (at: LatLon): LatLon => plane.from_plane(place(plane.to_plane(at)));
    const touched = with_followers(plan, picked);
    const items = plan.items.map((item, index) => {
      if (!touched.has(index)) return item;
      const changed = with_end(change(item), moved);
      const at = place_of(item);
      return at && picked.has(index) ? at_place(changed, moved(at)) : changed;
    });
    return { ...plan, items };
  };

const same = (item: Item): Item => item;

export const move_items =
  (picked: Picked, by: Offset): PlanAction =>
  (plan) =>
    by.east_m === 0 && by.north_m === 0
      ? plan
      : as_figure(picked, null, {
          place: ({ east_m, north_m }) => ({
            east_m: east_m + by.east_m,
            north_m: north_m + by.north_m,
          }),
          item: same,
        })(plan);

/** By what one of them was dragged. */
export const drag_items =
  (picked: Picked, index: number, to: LatLon): PlanAction =>
  (plan) => {
    const item = plan.items[index];
    const from = item && place_of(item);
    return from ? move_items(picked, offset_between(from, to))(plan) : plan;
  };

const with_heading = (item: Item, heading: (deg: number) => number): Item => {
  if (item.type === 'turn' && typeof item.heading_deg === 'number') {
    return { ...item, heading_deg: compass(heading(item.heading_deg)) };
  }
  return item;
};

/** @param deg clockwise */
export const rotate_items = (picked: Picked, deg: number, about: LatLon | null): PlanAction => {
  if (deg % FULL_DEG === 0) return (plan) => plan;
  const [sin, cos] = [Math.sin(deg * RAD), Math.cos(deg * RAD)];
  return as_figure(picked, about, {
    place: ({ east_m, north_m }) => ({
      east_m: east_m * cos + north_m * sin,
      north_m: north_m * cos - east_m * sin,
    }),
    item: (item) => with_heading(item, (heading) => heading + deg),
  });
};

/** To the millimetre. */
const scaled = (length_m: number, factor: number): number =>
  Math.round(length_m * factor * 1000) / 1000;

export const scale_items = (picked: Picked, factor: number, about: LatLon | null): PlanAction => {
  if (factor === 1) return (plan) => plan;
  return as_figure(picked, about, {
    place: ({ east_m, north_m }) => ({ east_m: east_m * factor, north_m: north_m * factor }),
    item: (item) => {
      if (item.type === 'move') return { ...item, forward_m: scaled(item.forward_m, factor) };
      if (item.type === 'turn' && typeof item.radius_m === 'number') {
        return { ...item, radius_m: scaled(item.radius_m, factor) };
      }
      return item.type === 'circle' ? { ...item, radius_m: scaled(item.radius_m, factor) } : item;
    },
  });
};

const mirrored = (item: Item, axis_deg: number): Item => {
  switch (item.type) {
    case 'circle':
      return { ...item, clockwise: item.clockwise !== true };
    case 'turn':
      return typeof item.turn_deg === 'number'
        ? { ...item, turn_deg: -item.turn_deg }
        : with_heading(item, (heading) => 2 * axis_deg - heading);
    case 'wall':
      return { ...item, side: item.side === 'left' ? 'right' : 'left' };
    case 'row':
      if (item.side === 'left') return { ...item, side: 'right' };
      return item.side === 'right' ? { ...item, side: 'left' } : item;
    case 'landmarks':
      return typeof item.offset_m === 'number'
        ? { ...item, offset_m: -item.offset_m }
        : { ...item, side: item.side === 'left' ? 'right' : 'left' };
    default:
      return item;
  }
};

/** @param axis_deg compass direction of the axis: 0 changes east and west */
export const mirror_items = (
  picked: Picked,
  axis_deg: number,
  about: LatLon | null,
): PlanAction => {
  const [sin, cos] = [Math.sin(2 * axis_deg * RAD), Math.cos(2 * axis_deg * RAD)];
  return as_figure(picked, about, {
    place: ({ east_m, north_m }) => ({
      east_m: north_m * sin - east_m * cos,
      north_m: north_m * cos + east_m * sin,
    }),
    item: (item) => mirrored(item, axis_deg),
  });
};

/** What a line of places becomes, and what lies beside the leg that begins with its place k. */
interface LineChange {
  readonly places: (offsets: readonly Offset[]) => readonly Offset[];
  readonly beside: (at: Offset, offsets: readonly Offset[], k: number) => Offset;
}

/** The chosen places by what a function of all of them says, and where a row or a wall ends with them. */
const with_places = (plan: Plan, picked: Picked, change: LineChange): Plan => {
  const found = picked_spots(plan, picked);
  const [origin] = found;
  if (!origin) return plan;
  const plane = plane_at(origin);
  const offsets = found.map((spot) => plane.to_plane(spot));
  const changed = change.places(offsets);
  const items = [...plan.items];
  found.forEach(({ index }, k) => {
    const [item, offset] = [items[index], changed[k]];
    if (item && offset) items[index] = at_place(item, plane.from_plane(offset));
  });
  for (const index of with_followers(plan, picked)) {
    const item = items[index];
    const k = Math.max(
      0,
      found.findLastIndex((spot) => spot.index <= index),
    );
    const moved = (at: LatLon): LatLon =>
      plane.from_plane(change.beside(plane.to_plane(at), offsets, k));
    if (item) items[index] = with_end(item, moved);
  }
  return { ...plan, items };
};

/** Onto the line from a to b. */
const onto_line = (p: Offset, a: Offset, b: Offset): Offset => {
  const [east, north] = [b.east_m - a.east_m, b.north_m - a.north_m];
  const length2 = east * east + north * north;
  if (length2 === 0) return p;
  const share = ((p.east_m - a.east_m) * east + (p.north_m - a.north_m) * north) / length2;
  return { east_m: a.east_m + share * east, north_m: a.north_m + share * north };
};

/** Onto the straight line from the first to the last of them. */
export const align_items =
  (picked: Picked): PlanAction =>
  (plan) => {
    const straight = (p: Offset, offsets: readonly Offset[]): Offset => {
      const [a, b] = [offsets[0], offsets.at(-1)];
      return a && b ? onto_line(p, a, b) : p;
    };
    return with_places(plan, picked, {
      places: (offsets) => offsets.map((p) => straight(p, offsets)),
      beside: straight,
    });
  };

/** Sharper corners than this are cut: no spike runs away. */
const MITER_MOST = 4;

const unit = (from: Offset | undefined, to: Offset | undefined): Offset | null => {
  if (!from || !to) return null;
  const [east, north] = [to.east_m - from.east_m, to.north_m - from.north_m];
  const length = Math.hypot(east, north);
  return length < 1e-6 ? null : { east_m: east / length, north_m: north / length };
};

/** So far to the right of where it is, seen along a. */
const to_the_right = (at: Offset, a: Offset, right_m: number): Offset => ({
  east_m: at.east_m + a.north_m * right_m,
  north_m: at.north_m - a.east_m * right_m,
});

const beside_line = (offsets: readonly Offset[], right_m: number): readonly Offset[] =>
  offsets.map((at, k) => {
    const before = unit(offsets[k - 1], at);
    const after = unit(at, offsets[k + 1]);
    const [a, b] = [before ?? after, after ?? before];
    if (!a || !b) return at;
    // Along the mean of the two normals, as long as the legs' distance asks for.
    const [east, north] = [a.north_m + b.north_m, -a.east_m - b.east_m];
    const size = Math.hypot(east, north);
    if (size < 1e-6) return to_the_right(at, a, right_m);
    const miter = Math.min(2 / size, MITER_MOST);
    return {
      east_m: at.east_m + (east / size) * miter * right_m,
      north_m: at.north_m + (north / size) * miter * right_m,
    };
  });

/** The line through them, so far to its right: each leg stays parallel to itself.
 * @param right_m negative: to its left */
export const parallel_items = (picked: Picked, right_m: number): PlanAction => {
  if (right_m === 0) return (plan) => plan;
  return (plan) =>
    with_places(plan, picked, {
      places: (offsets) => beside_line(offsets, right_m),
      beside: (at, offsets, k) => {
        const leg = unit(offsets[k], offsets[k + 1]) ?? unit(offsets[k - 1], offsets[k]);
        return leg ? to_the_right(at, leg, right_m) : at;
      },
    });
};
