// Modes, single moves and the speed's reason in words that a person in the field understands, and
// what of them makes sense now. The robot has the last word: its own reason is shown then.

import { robot_says } from './robot_words';
import { count, metres } from './format';
import { by_hand, why_not_mode, type Facts } from './operations';
import type { Mark } from './ports';
import { say, told } from './say';
import type { Activity, Mode, Vehicle } from './vehicle';

export interface ModeWords {
  readonly title: string;
  readonly does: string;
}
export const mode_words: Record<Mode, ModeWords> = {
  HOLD: told({ title: 'stand_still', does: 'stops_and_stays_a_mission_waits' }),
  MANUAL: told({ title: 'by_hand', does: 'you_drive_with_the_pad_freely' }),
  AUTO: told({ title: 'mission', does: 'drives_the_loaded_mission_or_goes_on' }),
  GUIDED: told({ title: 'guided', does: 'waits_for_a_place_tap_the_map_and' }),
  RTL: told({ title: 'come_home', does: 'drives_straight_to_home_or_to_a' }),
  SMART_RTL: told({ title: 'home_the_same_way', does: 'drives_back_where_it_came_from' }),
  FOLLOW: told({ title: 'follow', does: 'keeps_behind_a_target_that_another' }),
  DOCK: told({ title: 'dock', does: 'drives_slowly_and_straight_into_a' }),
  LOITER: told({ title: 'stay_here', does: 'stays_where_it_is_slid_away_it' }),
  CIRCLE: told({ title: 'circle', does: 'drives_around_a_place' }),
  STEERING: told({ title: 'steering', does: 'you_drive_it_keeps_its_heading_and' }),
  ACRO: told({ title: 'turn_rate', does: 'you_drive_let_go_sideways_and_it' }),
  SIMPLE: told({
    title: 'simple',
    does: 'you_drive_up_on_the_pad_is_where_the',
  }),
};

const reasons: Readonly<Record<string, string>> = told({
  item: 'as_fast_as_set',
  bend: 'slower_in_the_bend',
  approach: 'slower_before_a_stop_or_corner',
  heading_uncertain: 'creeps_heading_uncertain',
  heading_error: 'slower_does_not_face_along_the_path',
  heading_unknown: 'stands_heading_unknown',
  turn_rate: 'slower_turning',
  steering: 'slower_steering_turns_first',
  acceleration: 'speeding_up_or_slowing_down',
  position_uncertain: 'slower_position_uncertain',
  slope: 'slower_on_a_slope',
  pivot: 'turning_on_the_spot',
  stopping: 'stopping',
  standing: 'standing',
  manual: 'as_fast_as_your_hand_says',
  hand: 'as_fast_as_the_trigger_is_drawn',
  obstacle: 'limited_by_what_stands_there',
  around: 'goes_around_what_stands_there',
  link_delay: 'slow_the_link_is_late',
  teleop_stale: 'stopped_the_page_was_not_heard',
  fence: 'limited_by_the_fence',
});

/** Why it is as fast as it is. A reason that this page does not know is shown as it came. */
export const speed_reason_words = (reason: string): string =>
  reasons[reason] ?? reason.replaceAll('_', ' ');

const heads: Readonly<Record<NonNullable<Activity['kind']>, string>> = told({
  goto: 'going_to_the_place',
  heading: 'driving_a_heading',
  move: 'moving_straight',
  turn: 'turning',
  return: 'coming_home',
  retrace: 'coming_home_the_same_way',
  calibration: 'measuring_how_it_drives',
  follow: 'following',
  dock: 'docking',
  loiter: 'staying_at_the_place',
  circle: 'circling',
});

export interface ActivityLine {
  readonly head: string;
  readonly state: 'going' | 'waiting' | 'reached' | 'failed';
  readonly detail: string;
}

/** "3 m around, to the left, 2 turns". */
const round = ({ kind, radius_m, turns, clockwise }: Activity): string[] => {
  if (kind !== 'circle') return [];
  const side = clockwise ? say('to_the_right') : say('to_the_left');
  const often = turns === null ? say('no_end') : count(turns, 'turn');
  return [say('radius_around', { radius: metres(radius_m) }), side, often];
};

const left = (activity: Activity): string => {
  const { distance_m, turn_deg } = activity;
  const parts = round(activity);
  if (distance_m !== null) parts.push(say('distance_left', { distance: metres(distance_m) }));
  if (turn_deg !== null && Math.abs(turn_deg) >= 0.5) {
    parts.push(
      say(turn_deg < 0 ? 'turn_to_left' : 'turn_to_right', { turn: Math.abs(turn_deg).toFixed(0) }),
    );
  }
  return parts.join(', ');
};

/** What a mode other than AUTO does, or did last; null while there is nothing to say. */
export const activity_line = (vehicle: Vehicle | null): ActivityLine | null => {
  const activity = vehicle?.activity;
  if (!activity || activity.kind === null) return null;
  const head = heads[activity.kind];
  switch (activity.state) {
    case 'none':
      return null;
    case 'driving':
    case 'turning':
      return { head, state: 'going', detail: left(activity) };
    case 'waiting':
    case 'held':
      return { head, state: 'waiting', detail: robot_says(activity.reason) };
    case 'reached':
      return { head, state: 'reached', detail: say('done') };
    case 'failed':
      // Whoever chose another mode knows it.
      if (/^ended by mode (AUTO|\w+: by the operator$)/.test(activity.reason)) return null;
      return { head, state: 'failed', detail: robot_says(activity.reason) };
  }
};

/** Where a mode other than AUTO drives to, while it does. */
export const activity_mark = (vehicle: Vehicle | null): Mark | null => {
  if (!vehicle) return null;
  const { state, goal, goal_heading_deg, radius_m, clockwise } = vehicle.activity;
  const under_way =
    state === 'driving' || state === 'turning' || state === 'waiting' || state === 'held';
  if (!under_way || !goal) return null;
  const mark = { ...goal, heading_deg: goal_heading_deg };
  return radius_m === null ? mark : { ...mark, ring: { radius_m, clockwise } };
};

/** Why it cannot drive by itself now; null: it may. */
export const why_not_go = (facts: Facts): string | null =>
  why_not_mode(facts, 'GUIDED') ??
  (facts.vehicle?.armed === true ? null : say('arm_the_robot_first'));

/** The same for any mode of the menu. */
export const why_not_choose = (facts: Facts, mode: Mode): string | null => {
  if (mode === 'HOLD' || by_hand(mode)) return why_not_mode(facts, mode);
  const before = why_not_go(facts);
  if (before !== null) return before;
  switch (mode) {
    case 'RTL':
      return facts.vehicle?.home === null ? say('the_robot_has_no_home') : null;
    case 'FOLLOW':
      return facts.vehicle?.activity.target === null
        ? say('nothing_has_told_where_to_follow')
        : null;
    case 'DOCK':
      return say('tap_the_map_where_it_shall_dock');
    case 'CIRCLE':
      return say('tap_the_map_where_it_shall_circle');
    default:
      return null;
  }
};
