// The mission as the page edits it: plain immutable values in the words of the public interface.
// Item numbers shown to people start at 1; indices here start at 0.

import { count, number_text } from './format';
import { say, told } from './say';
import { speed_text, type SpeedUnit } from './settings';

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
/** Exactly one of the first two: relative (clockwise positive) or absolute. */
export interface Turn {
  readonly type: 'turn';
  readonly turn_deg?: number | null;
  readonly heading_deg?: number | null;
  /** Forwards on an arc of this; none: on the spot. */
  readonly radius_m?: number | null;
}
export interface Wait {
  readonly type: 'wait';
  readonly seconds: number;
}
export interface Speed {
  readonly type: 'speed';
  readonly speed_mps: number;
}
/** Done at the latest beside a place: one of the map, both or none, or a known one by its name. */
export interface EndsBeside {
  readonly until_lat?: number | null;
  readonly until_lon?: number | null;
  readonly until_place?: string | null;
}
export interface Row extends EndsBeside {
  readonly type: 'row';
  readonly side?: RowSide;
  readonly gap_m?: number | null;
  readonly speed_mps?: number | null;
  readonly distance_m?: number | null;
  readonly seeing?: 'line' | 'rays';
}
/** By whose word; absent: as the robot's parameters say. */
export type SightSource = 'auto' | 'scan' | 'vision';
export interface Wall extends EndsBeside {
  readonly type: 'wall';
  readonly side: Side;
  /** From the wall; absent: as the robot's parameters say. */
  readonly distance_m?: number | null;
  readonly speed_mps?: number | null;
  readonly length_m?: number | null;
  readonly source?: SightSource | null;
  /** Those that stand along it are driven past first. */
  readonly landmarks_first?: boolean;
}
export interface Landmarks {
  readonly type: 'landmarks';
  readonly name: string;
  /** The vehicle passes them so far to their left; negative: to their right. */
  readonly offset_m?: number | null;
  /** Instead: where they are; how far off, the robot's parameters say. */
  readonly side?: Side | null;
  readonly speed_mps?: number | null;
  /** Done behind so many; absent: behind the last. */
  readonly count?: number | null;
  readonly source?: SightSource | null;
}
/** Before a tag, by sight. */
export interface Dock {
  readonly type: 'dock';
  /** Its number. */
  readonly tag: number;
  /** From the tag to the vehicle's middle; absent: as the profile says. */
  readonly stand_off_m?: number | null;
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

/** A place of the mission's map, in the map's own frame. */
export interface OnMap {
  readonly type: 'map_point';
  readonly x_m: number;
  readonly y_m: number;
  /** To point there: from the map's x axis, left positive. */
  readonly yaw_deg?: number | null;
  readonly speed_mps?: number | null;
  readonly radius_m?: number | null;
  readonly hold_s?: number | null;
  readonly reverse?: boolean;
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
  | Dock
  | Jump
  | ReturnHome
  | Action
  | Loiter
  | Circle
  | OnMap;
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
  /** The map that map points count from, by its name. */
  readonly frame?: { readonly map: string } | null;
  /** What the items were drawn as, kept by the robot with each revision; what is in it, makings.ts knows. */
  readonly drawing?: KeptDrawing | null;
}
export interface KeptDrawing {
  readonly kind: string;
  readonly [member: string]: unknown;
}

export const EMPTY_PLAN: Plan = {
  get name() {
    return say('new_mission');
  },
  items: [],
};

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

const wall_text = ({ side, distance_m }: Wall): string =>
  typeof distance_m === 'number'
    ? say(side === 'left' ? 'wall_on_left' : 'wall_on_right', { distance: distance_m })
    : say(side === 'left' ? 'wall_left' : 'wall_right');

const landmarks_text = ({ name, side, offset_m }: Landmarks): string =>
  typeof offset_m === 'number'
    ? say('landmarks_name_offset_m', { name, offset: offset_m })
    : say(side === 'right' ? 'landmarks_right' : 'landmarks_left', { name });

const turn_text = ({ turn_deg, heading_deg, radius_m }: Turn): string => {
  if (typeof turn_deg !== 'number') {
    const heading = heading_deg ?? 0;
    return radius_m
      ? say('turn_to_heading_on_an_arc', { heading, radius: radius_m })
      : say('turn_to_heading_heading_deg', { heading });
  }
  return radius_m
    ? say('turn_on_an_arc', { turn: turn_deg, radius: radius_m })
    : say('turn_turn_deg', { turn: turn_deg });
};

/** A sentence for an item that has no place on the map (also used in the item list). */
export const item_title = (item: Item, speed_in: SpeedUnit = 'm/s'): string => {
  switch (item.type) {
    case 'waypoint':
      return item.reverse === true ? say('waypoint_backwards') : say('waypoint');
    case 'local':
      return say('local_east_m_east_north_m_north', { east: item.east_m, north: item.north_m });
    case 'map_point':
      return say('map_point_x_m_y_m', {
        x: number_text(item.x_m, 2),
        y: number_text(item.y_m, 2),
      });
    case 'move':
      return item.forward_m < 0
        ? say('back_forward_m', { forward: -item.forward_m })
        : say('forward_forward_m', { forward: item.forward_m });
    case 'turn':
      return turn_text(item);
    case 'wait':
      return say('wait_seconds_s', { seconds: item.seconds });
    case 'speed':
      return say('speed_speed_m_s', { speed: speed_text(item.speed_mps, speed_in) });
    case 'row':
      return (item.side ?? 'both') === 'both'
        ? say('row_in_its_middle')
        : item.side === 'left'
          ? say('row_on_left')
          : say('row_on_right');
    case 'wall':
      return wall_text(item);
    case 'landmarks':
      return landmarks_text(item);
    case 'dock':
      return say('dock_at_tag_tag', { tag: item.tag });
    case 'jump':
      return say('jump_to_item_times', {
        item: item.item,
        times: item.times === 0 ? say('for_ever') : `${item.times}×`,
      });
    case 'return_home':
      return say('return_home');
    case 'action':
      return say('action_name', { name: item.name });
    case 'loiter': {
      const where = place_of(item) === null ? say('stay_here') : say('stay');
      return typeof item.seconds === 'number'
        ? `${where} ${item.seconds} s`
        : say('where_until_resumed', { where });
    }
    case 'circle': {
      const turns = item.turns ?? 1;
      return say(item.clockwise === true ? 'circle_to_right' : 'circle_to_left', {
        radius: item.radius_m,
        turns: count(turns, 'turn'),
      });
    }
  }
};

export const at_end_words: Record<AtEnd, string> = told({
  hold: 'stops_and_holds',
  return: 'returns_home',
  repeat: 'starts_again_from_the_first_item',
  back_and_forth: 'drives_the_route_back_again',
});
