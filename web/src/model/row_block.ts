// A block of rows of plants: what is asked for, and where the way through it leads, as far as a map
// can tell: where the rows end is seen by the robot alone, and drawn as the person drew the first one.

import { distance_m, offset_from } from './geo';
import type { Item, LatLon, Plan, RowSide, Side } from './plan';
import { say } from './say';

/** From row to row: `auto` as suits the vehicle. */
export const ROW_TURNS = ['auto', 'pivot', 'arc', 'omega', 'shunt'] as const;
export type RowTurn = (typeof ROW_TURNS)[number];

export interface RowsWish {
  /** Lanes to drive. */
  readonly rows: number;
  /** From the middle of one to that of the next. */
  readonly spacing_m: number;
  /** Where row 2 lies, seen along row 1. */
  readonly turn: Side;
  /** So many rows are left out each time, and driven on later passes. */
  readonly skip: number;
  /** Out of a row before it turns. */
  readonly out_m: number;
  readonly turn_kind: RowTurn;
  /** Of arcs; null: as suits the vehicle. */
  readonly radius_m: number | null;
  /** Every other row is driven the other way; else all are entered at the same end. */
  readonly alternating: boolean;
  /** Null: where the robot stands when it starts, pointing along row 1. */
  readonly entry: RowEntry | null;
  /** Row 1 ends here: rows end at the latest there; null: where the robot sees it. */
  readonly to: LatLon | null;
  readonly side: RowSide;
  /** Along one side; null: the usual one. */
  readonly gap_m: number | null;
  readonly speed_mps: number | null;
  /** Null: to the row's end. */
  readonly distance_m: number | null;
  readonly seeing: 'line' | 'rays';
}
export interface RowEntry {
  readonly at: LatLon;
  /** Compass, along row 1. */
  readonly heading_deg: number;
}
export interface RowBlock {
  /** Numbers of the rows, from 1, as they are driven. */
  readonly order: readonly number[];
  /** So far beyond the rows' ends the vehicle comes. */
  readonly headland_m: number;
  readonly plan: Plan;
}

/** @param places what is tapped: where row 1 begins, and along it */
export const why_not_rows = (by_place: boolean, places: readonly LatLon[]): string | null => {
  if (!by_place || places.length > 1) return null;
  return say(places.length === 0 ? 'tap_where_row_1_begins' : 'tap_where_row_1_ends');
};

/** Rows are drawn so long where nothing tells. */
export const USUAL_ROW_M = 20;

/** How long rows are drawn: as far as is driven of them, else as long as the first one was drawn. */
export const row_length_m = (driven_m: number | null, [at, toward]: readonly LatLon[]): number =>
  driven_m ?? (at && toward ? distance_m(at, toward) : USUAL_ROW_M);

export interface DrawnBlock {
  /** From plant to plant, as they are driven. */
  readonly rows: readonly (readonly LatLon[])[];
  /** All of it, with the turns. */
  readonly way: readonly LatLon[];
}

const RAD = Math.PI / 180;

/** From the beginning of row 1: along it, and to its right. */
interface Spot {
  readonly along_m: number;
  readonly right_m: number;
}

/** Of a turn that is an arc: a piece each 15 degrees. */
const ARC_PIECE_DEG = 15;

/** @param radius_m 0: on the spot */
const pieces_of = (
  by_deg: number,
  radius_m: number,
): readonly { readonly half_deg: number; readonly chord_m: number }[] => {
  const count = radius_m > 0 ? Math.max(1, Math.ceil(Math.abs(by_deg) / ARC_PIECE_DEG)) : 1;
  const half_deg = (0.5 * by_deg) / count;
  const piece = { half_deg, chord_m: 2 * radius_m * Math.sin(Math.abs(half_deg) * RAD) };
  return Array.from({ length: count }, () => piece);
};

/** @param length_m how long the rows are thought to be @param items row, move and turn items; others
 * move nothing */
export const drawn_block = (
  items: readonly Item[],
  { at, heading_deg }: RowEntry,
  length_m: number,
): DrawnBlock => {
  const cos = Math.cos(heading_deg * RAD);
  const sin = Math.sin(heading_deg * RAD);
  const place = ({ along_m, right_m }: Spot): LatLon =>
    offset_from(at, {
      east_m: along_m * sin + right_m * cos,
      north_m: along_m * cos - right_m * sin,
    });
  const within = (along_m: number): number => Math.min(Math.max(0, along_m), length_m);
  const rows: LatLon[][] = [];
  let here: Spot = { along_m: 0, right_m: 0 };
  const way = [place(here)];
  let turned_deg = 0;
  const forward = (by_m: number): void => {
    here = {
      along_m: here.along_m + by_m * Math.cos(turned_deg * RAD),
      right_m: here.right_m + by_m * Math.sin(turned_deg * RAD),
    };
    way.push(place(here));
  };
  for (const item of items) {
    if (item.type === 'turn') {
      const by_deg =
        typeof item.turn_deg === 'number'
          ? item.turn_deg
          : (item.heading_deg ?? heading_deg) - heading_deg - turned_deg;
      for (const { half_deg, chord_m } of pieces_of(by_deg, item.radius_m ?? 0)) {
        turned_deg += half_deg;
        if (chord_m > 0) forward(chord_m);
        turned_deg += half_deg;
      }
    } else if (item.type === 'move') {
      forward(item.forward_m);
    } else if (item.type === 'row') {
      const forth = Math.cos(turned_deg * RAD) > 0;
      const begin = here;
      const to_end_m = forth ? length_m - begin.along_m : begin.along_m;
      forward(Math.min(item.distance_m ?? Infinity, Math.max(0, to_end_m)));
      rows.push(
        [begin.along_m, here.along_m].map((along_m) =>
          place({ along_m: within(along_m), right_m: begin.right_m }),
        ),
      );
    }
  }
  return { rows, way };
};

/** "1 3 5 2 4"; of many the first ones. */
export const order_text = (order: readonly number[], most = 24): string =>
  order.length > most ? `${order.slice(0, most).join(' ')} …` : order.join(' ');
