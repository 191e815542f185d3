// What the guard does about what stands in the way: the words for it, the place on the map, and which
// sound it makes.

import { robot_says } from './robot_words';
import { sentence } from './format';
import { offset_from } from './geo';
import type { LatLon } from './plan';
import { say, told } from './say';

export interface Obstacle {
  readonly action: 'slow' | 'creep' | 'stop' | 'overridden';
  readonly what: 'obstacle' | 'drop' | 'unseen' | 'blind';
  /** From the vehicle's origin. */
  readonly distance_m: number;
  /** On the body, clockwise from straight ahead. */
  readonly bearing_deg: number;
  readonly sensor: string | null;
  readonly age_s: number;
  /** The drive has been stopped for so long; null: it is not. */
  readonly stopped_s: number | null;
  readonly reason: string;
  /** It has limited or stopped the drive for so long. */
  readonly since_s?: number | null;
  /** The drive waits for somebody to help. */
  readonly blocked?: boolean | null;
  /** What comes of waiting. */
  readonly then?: string | null;
  readonly decides_in_s?: number | null;
  /** There is none around it: why. */
  readonly no_way?: string | null;
}

const then_words: Readonly<Record<string, string>> = told({
  wait: 'it_waits_on',
  around: 'it_looks_for_a_way_around',
  return: 'it_drives_back',
  abort: 'the_mission_ends',
});

/** "12 s", "3 min" */
const lasting = (seconds: number): string =>
  seconds < 90 ? `${Math.max(1, Math.round(seconds))} s` : `${Math.round(seconds / 60)} min`;

/** Since when, and what comes next: "For 12 s. In 8 s it looks for a way around.", "For 20 s. Blocked:
 * it looks for a way around."
 * @param older_s since the robot said so */
export const obstacle_since = (obstacle: Obstacle, older_s: number): string => {
  const parts: string[] = [];
  const since_s = obstacle.stopped_s ?? obstacle.since_s ?? null;
  if (since_s !== null) parts.push(say('for_since', { since: lasting(since_s + older_s) }));
  const then = obstacle.then ?? '';
  const words = then_words[then] ?? then.replaceAll('_', ' ');
  const left_s = obstacle.decides_in_s ?? null;
  const left = left_s === null ? null : lasting(Math.max(0, left_s - older_s));
  const soon = left === null ? say('then') : say('in_left', { left });
  if (obstacle.no_way) parts.push(say('no_way_around_it', { why: robot_says(obstacle.no_way) }));
  else if (obstacle.blocked === true)
    parts.push(words === '' ? say('blocked') : say('blocked_words', { words }));
  else if (then === 'wait' && left !== null) parts.push(say('in_left_it_is_blocked', { left }));
  else if (words !== '') parts.push(`${soon} ${words}.`);
  return parts.join(' ');
};

/** "It slows: something stands in the way, 1.2 m ahead, seen by front." */
export const obstacle_line = ({ action, reason }: Obstacle): string => {
  const why = robot_says(reason);
  if (action === 'stop') return `${sentence(why)}.`;
  if (action === 'overridden')
    return say('the_guard_is_overridden_by_hand_reason', { reason: why });
  return `${action === 'creep' ? say('it_creeps') : say('it_slows')}: ${why}.`;
};

/** A place on the body, on the map. @param heading_deg of the body */
export const place_on_body = (
  from: LatLon,
  heading_deg: number,
  ahead_m: number,
  left_m: number,
): LatLon => {
  const heading = (heading_deg * Math.PI) / 180;
  return offset_from(from, {
    east_m: ahead_m * Math.sin(heading) - left_m * Math.cos(heading),
    north_m: ahead_m * Math.cos(heading) + left_m * Math.sin(heading),
  });
};

/** Where what limits the drive stands; nothing: that is no place. */
export const obstacle_place = (
  obstacle: Obstacle | null | undefined,
  from: LatLon | null,
  heading_deg: number | null,
): LatLon | null => {
  if (!obstacle || obstacle.what === 'blind' || !from || heading_deg === null) return null;
  const bearing = (obstacle.bearing_deg * Math.PI) / 180;
  const { distance_m } = obstacle;
  const [ahead_m, left_m] = [distance_m * Math.cos(bearing), -distance_m * Math.sin(bearing)];
  return place_on_body(from, heading_deg, ahead_m, left_m);
};

export type Sound = 'stopped' | 'free' | 'blocked';

/** What is heard when something happens on the robot; null: nothing. */
export const sound_of = (kind: string): Sound | null => {
  if (kind === 'obstacle') return 'stopped';
  if (kind === 'obstacle_gone') return 'free';
  return kind === 'blocked' || kind === 'mission_blocked' ? 'blocked' : null;
};

/** A hand may hold the guard off while it limits that hand's drive. */
export const may_override = (
  obstacle: Obstacle | null | undefined,
  teleop: 'off' | 'release' | 'ready' | 'held' | undefined,
): boolean => !!obstacle && (teleop === 'held' || teleop === 'ready');
