// The mission as the page edits it: plain immutable values in the words of the public interface.
// Item numbers shown to people start at 1; indices here start at 0.

/** WGS84 degrees. */
export interface LatLon {
  readonly lat: number;
  readonly lon: number;
}

export type TurnStyle = 'auto' | 'pivot' | 'arc' | 'through';
export type Side = 'left' | 'right';
export type RowSide = 'both' | Side;
export type AtEnd = 'hold' | 'return' | 'repeat' | 'back_and_forth';

export interface Waypoint extends LatLon {
  readonly type: 'waypoint';
  readonly alt_m?: number | null;
  /** For the leg that leads here. */
  readonly speed_mps?: number | null;
  /** Counts as reached within. */
  readonly radius_m?: number | null;
  readonly hold_s?: number | null;
  readonly reverse?: boolean;
  readonly turn?: TurnStyle;
}
export interface Local {
  readonly type: 'local';
  readonly east_m: number;
  readonly north_m: number;
  readonly heading_deg?: number | null;
}
export interface Move {
  readonly type: 'move';
  readonly forward_m: number;
}
/** Exactly one of the two: relative (clockwise positive) or absolute. */
export interface Turn {
  readonly type: 'turn';
  readonly turn_deg?: number | null;
  readonly heading_deg?: number | null;
}
export interface Wait {
  readonly type: 'wait';
  readonly seconds: number;
}
export interface Speed {
  readonly type: 'speed';
  readonly speed_mps: number;
}
export interface Row {
  readonly type: 'row';
  readonly side?: RowSide;
  readonly gap_m?: number | null;
  readonly speed_mps?: number | null;
  readonly distance_m?: number | null;
  readonly seeing?: 'line' | 'rays';
}
export interface Wall {
  readonly type: 'wall';
  readonly side: Side;
  readonly distance_m: number;
  readonly speed_mps?: number | null;
  readonly length_m?: number | null;
}
export interface Landmarks {
  readonly type: 'landmarks';
  readonly name: string;
  /** The vehicle passes them so far to their left; negative: to their right. */
  readonly offset_m: number;
  readonly speed_mps?: number | null;
  /** Done behind so many; absent: behind the last. */
  readonly count?: number | null;
}
export interface Jump {
  readonly type: 'jump';
  /** Item number, from 1. */
  readonly item: number;
  /** 0 = for ever. */
  readonly times: number;
}
export interface ReturnHome {
  readonly type: 'return_home';
}
export interface Action {
  readonly type: 'action';
  readonly name: string;
  readonly [argument: string]: unknown;
}

/** Stays at a place, or where the robot stands; driven away from it, it drives back. */
export interface Loiter {
  readonly type: 'loiter';
  /** Both or none. */
  readonly lat?: number | null;
  readonly lon?: number | null;
  /** Nothing: until somebody says to go on. */
  readonly seconds?: number | null;
  readonly radius_m?: number | null;
}
/** Around a place: its centre. */
export interface Circle extends LatLon {
  readonly type: 'circle';
  readonly radius_m: number;
  readonly turns?: number | null;
  readonly clockwise?: boolean;
  readonly speed_mps?: number | null;
  /** So many times a turn it stops and faces the centre. */
  readonly stations?: number | null;
  readonly hold_s?: number | null;
}

export type Item =
  | Waypoint
  | Local
  | Move
  | Turn
  | Wait
  | Speed
  | Row
  | Wall
  | Landmarks
  | Jump
  | ReturnHome
  | Action
  | Loiter
  | Circle;
export type ItemType = Item['type'];

export interface Home extends LatLon {
  readonly alt_m?: number | null;
}
export interface Settings {
  readonly at_end?: AtEnd;
  /** Default speed of the mission. */
  readonly speed_mps?: number | null;
  /** With repeat and back_and_forth: how often; 0 or nothing: for ever. */
  readonly times?: number | null;
  /** Half width of the way that it may use, metres. */
  readonly corridor_m?: number | null;
}
export interface Plan {
  readonly name: string;
  readonly home?: Home | null;
  readonly settings?: Settings;
  readonly items: readonly Item[];
}

export const EMPTY_PLAN: Plan = { name: 'New mission', items: [] };

/** A positional item: where it is, and which item it is. */
export interface Spot extends LatLon {
  readonly index: number;
}

/** Where an item lies on the map: a waypoint, a loiter at a place, a circle's centre. */
export const place_of = (item: Item): LatLon | null => {
  if (item.type === 'waypoint' || item.type === 'circle') return { lat: item.lat, lon: item.lon };
  if (item.type !== 'loiter') return null;
  return typeof item.lat === 'number' && typeof item.lon === 'number'
    ? { lat: item.lat, lon: item.lon }
    : null;
};

/** The items that have a place on the map, in driving order. */
export const spots = (plan: Plan): Spot[] => {
  const found: Spot[] = [];
  plan.items.forEach((item, index) => {
    const at = place_of(item);
    if (at) found.push({ index, ...at });
  });
  return found;
};

/** A sentence for an item that has no place on the map (also used in the item list). */
export const item_title = (item: Item): string => {
  switch (item.type) {
    case 'waypoint':
      return item.reverse === true ? 'Waypoint, backwards' : 'Waypoint';
    case 'local':
      return `Local ${item.east_m} m east, ${item.north_m} m north`;
    case 'move':
      return item.forward_m < 0 ? `Back ${-item.forward_m} m` : `Forward ${item.forward_m} m`;
    case 'turn':
      return typeof item.turn_deg === 'number'
        ? `Turn ${item.turn_deg}°`
        : `Turn to heading ${item.heading_deg ?? 0}°`;
    case 'wait':
      return `Wait ${item.seconds} s`;
    case 'speed':
      return `Speed ${item.speed_mps} m/s`;
    case 'row':
      return (item.side ?? 'both') === 'both' ? 'Row, in its middle' : `Row on the ${item.side}`;
    case 'wall':
      return `Wall on the ${item.side}, ${item.distance_m} m`;
    case 'landmarks':
      return `Landmarks “${item.name}”, ${item.offset_m} m`;
    case 'jump':
      return `Jump to ${item.item}, ${item.times === 0 ? 'for ever' : `${item.times}×`}`;
    case 'return_home':
      return 'Return home';
    case 'action':
      return `Action “${item.name}”`;
    case 'loiter': {
      const where = place_of(item) === null ? 'Stay here' : 'Stay';
      return typeof item.seconds === 'number'
        ? `${where} ${item.seconds} s`
        : `${where} until resumed`;
    }
    case 'circle': {
      const turns = item.turns ?? 1;
      const way = item.clockwise === true ? 'right' : 'left';
      return `Circle of ${item.radius_m} m, ${turns} ${turns === 1 ? 'turn' : 'turns'} to the ${way}`;
    }
  }
};

export const at_end_words: Record<AtEnd, string> = {
  hold: 'stops and holds',
  return: 'returns home',
  repeat: 'starts again from the first item',
  back_and_forth: 'drives the route back again',
};
