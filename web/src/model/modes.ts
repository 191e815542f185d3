// Modes, single moves and the speed's reason in words that a person in the field understands, and
// what of them makes sense now. The robot has the last word: its own reason is shown then.

import { metres } from './format';
import { by_hand, why_not_mode, type Facts } from './operations';
import type { Mark } from './ports';
import type { Activity, Mode, Vehicle } from './vehicle';

export interface ModeWords {
  readonly title: string;
  readonly does: string;
}
export const mode_words: Record<Mode, ModeWords> = {
  HOLD: { title: 'Stand still', does: 'Stops and stays. A mission waits.' },
  MANUAL: { title: 'By hand', does: 'You drive with the pad, freely.' },
  AUTO: { title: 'Mission', does: 'Drives the loaded mission, or goes on with it.' },
  GUIDED: { title: 'Guided', does: 'Waits for a place: tap the map and press “Go here”.' },
  RTL: { title: 'Come home', does: 'Drives straight to home or to a rally point.' },
  SMART_RTL: { title: 'Home the same way', does: 'Drives back where it came from.' },
  FOLLOW: { title: 'Follow', does: 'Keeps behind a target that another program tells.' },
  DOCK: { title: 'Dock', does: 'Drives slowly and straight into a place, facing a given way.' },
  LOITER: { title: 'Stay here', does: 'Stays where it is; slid away, it drives back.' },
  CIRCLE: { title: 'Circle', does: 'Drives around a place.' },
  STEERING: { title: 'Steering', does: 'You drive; it keeps its heading and takes bends gently.' },
  ACRO: { title: 'Turn rate', does: 'You drive; let go sideways and it goes straight on.' },
  SIMPLE: {
    title: 'Simple',
    does: 'You drive; up on the pad is where the robot faces when you choose this.',
  },
};

const reasons: Readonly<Record<string, string>> = {
  item: 'as fast as set',
  bend: 'slower in the bend',
  approach: 'slower before a stop or corner',
  heading_uncertain: 'creeps: heading uncertain',
  heading_error: 'slower: does not face along the path yet',
  heading_unknown: 'stands: heading unknown',
  turn_rate: 'slower: turning',
  steering: 'slower: steering turns first',
  acceleration: 'speeding up or slowing down',
  position_uncertain: 'slower: position uncertain',
  slope: 'slower: on a slope',
  pivot: 'turning on the spot',
  stopping: 'stopping',
  standing: 'standing',
  manual: 'as fast as your hand says',
  obstacle: 'limited by what stands there',
  around: 'goes around what stands there',
  link_delay: 'slow: the link is late',
  teleop_stale: 'stopped: the page was not heard',
  fence: 'limited by the fence',
};

/** Why it is as fast as it is. A reason that this page does not know is shown as it came. */
export const speed_reason_words = (reason: string): string =>
  reasons[reason] ?? reason.replaceAll('_', ' ');

const heads: Readonly<Record<NonNullable<Activity['kind']>, string>> = {
  goto: 'Going to the place',
  heading: 'Driving a heading',
  move: 'Moving straight',
  turn: 'Turning',
  return: 'Coming home',
  retrace: 'Coming home the same way',
  calibration: 'Measuring how it drives',
  follow: 'Following',
  dock: 'Docking',
  loiter: 'Staying at the place',
  circle: 'Circling',
};

export interface ActivityLine {
  readonly head: string;
  readonly state: 'going' | 'waiting' | 'reached' | 'failed';
  readonly detail: string;
}

/** "3 m around, to the left, 2 turns". */
const round = ({ kind, radius_m, turns, clockwise }: Activity): string[] => {
  if (kind !== 'circle') return [];
  const side = clockwise ? 'to the right' : 'to the left';
  const often = turns === null ? 'no end' : turns === 1 ? '1 turn' : `${turns} turns`;
  return [`${metres(radius_m)} around`, side, often];
};

const left = (activity: Activity): string => {
  const { distance_m, turn_deg } = activity;
  const parts = round(activity);
  if (distance_m !== null) parts.push(`${metres(distance_m)} left`);
  if (turn_deg !== null && Math.abs(turn_deg) >= 0.5) {
    parts.push(`${Math.abs(turn_deg).toFixed(0)}° to the ${turn_deg < 0 ? 'left' : 'right'}`);
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
      return { head, state: 'waiting', detail: activity.reason };
    case 'reached':
      return { head, state: 'reached', detail: 'Done.' };
    case 'failed':
      // Whoever chose another mode knows it.
      if (/^ended by mode (AUTO|\w+: by the operator$)/.test(activity.reason)) return null;
      return { head, state: 'failed', detail: activity.reason };
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
  why_not_mode(facts, 'GUIDED') ?? (facts.vehicle?.armed === true ? null : 'Arm the robot first.');

/** The same for any mode of the menu. */
export const why_not_choose = (facts: Facts, mode: Mode): string | null => {
  if (mode === 'HOLD' || by_hand(mode)) return why_not_mode(facts, mode);
  const before = why_not_go(facts);
  if (before !== null) return before;
  switch (mode) {
    case 'RTL':
      return facts.vehicle?.home === null ? 'The robot has no home.' : null;
    case 'FOLLOW':
      return facts.vehicle?.activity.target === null ? 'Nothing has told where to follow.' : null;
    case 'DOCK':
      return 'Tap the map where it shall dock.';
    case 'CIRCLE':
      return 'Tap the map where it shall circle.';
    default:
      return null;
  }
};
