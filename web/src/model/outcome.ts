// A command had no answer. Whether it was obeyed is not known until the robot is asked: this compares
// its state before and after.

import { metres } from './format';
import { distance_m } from './geo';
import { activity_line } from './modes';
import type { LatLon } from './plan';
import {
  antennas_wait,
  estimate_waits,
  robot_place,
  shift_waits,
  type Activity,
  type Mode,
  type Vehicle,
} from './vehicle';

/** What a command should lead to. */
export type Wish =
  | { readonly to: 'arm' }
  | { readonly to: 'reset' }
  | { readonly to: 'acknowledge' }
  | { readonly to: 'settle_shift' }
  | { readonly to: 'correct_antennas' }
  | { readonly to: 'mode'; readonly mode: Mode }
  | { readonly to: 'do'; readonly kinds: readonly Activity['kind'][] }
  | { readonly to: 'load'; readonly id: string; readonly revision: number }
  | { readonly to: 'run' }
  | { readonly to: 'go_on' }
  | { readonly to: 'skip' }
  | { readonly to: 'home'; readonly at: LatLon }
  | { readonly to: 'stand'; readonly at: LatLon };

/** How long a click can be obeyed after it was made. */
export const CLICK_LIFE_S = 1;

export interface Outcome {
  /** Null: its state does not tell. */
  readonly obeyed: boolean | null;
  readonly detail: string;
}

const SAME_PLACE_M = 0.01;
/** A person shows a place no better. */
const TOLD_PLACE_M = 1;

const settled = (obeyed: boolean, still: string, done: string): Outcome => ({
  obeyed,
  detail: obeyed ? done : still,
});

const stands = (told: LatLon, before: Vehicle | null, after: Vehicle): Outcome => {
  const here = robot_place(after);
  if (!here) return { obeyed: false, detail: 'it does not know where it stands' };
  const off_m = distance_m(here, told);
  const there = robot_place(before);
  // It may have been there before; and what it saw there may have moved it already.
  const came = there === null || distance_m(there, told) >= TOLD_PLACE_M;
  const obeyed = off_m < TOLD_PLACE_M && came ? true : null;
  return { obeyed, detail: `it takes itself to stand ${metres(off_m)} from there` };
};

/** @param before the state that the person acted upon; null: none was seen */
export const outcome = (wish: Wish, before: Vehicle | null, after: Vehicle): Outcome => {
  const { mission } = after;
  switch (wish.to) {
    case 'arm':
      return { obeyed: after.armed, detail: `the robot is ${after.armed ? '' : 'not '}armed` };
    case 'reset':
      return {
        obeyed: !after.estop,
        detail: `the emergency stop is ${after.estop ? 'still latched' : 'reset'}`,
      };
    case 'acknowledge':
      return settled(!estimate_waits(after), 'it still waits for that', 'it was taken');
    case 'settle_shift':
      return settled(!shift_waits(after), 'it still asks which place counts', 'it was taken');
    case 'correct_antennas':
      return settled(!antennas_wait(after), 'they are still not used', 'they are corrected');
    case 'mode':
      return { obeyed: after.mode === wish.mode, detail: `the mode is ${after.mode}` };
    case 'do': {
      const fresh = after.activity.id !== before?.activity.id;
      const obeyed = fresh && wish.kinds.includes(after.activity.kind);
      const line = activity_line(after);
      const words = line ? `${line.head.toLowerCase()}: ${line.detail.toLowerCase()}` : '';
      return { obeyed, detail: obeyed && line ? words : `the mode is ${after.mode}` };
    }
    case 'load': {
      const obeyed = mission.id === wish.id && mission.revision === wish.revision;
      return { obeyed, detail: mission.name === null ? 'no mission is loaded' : has(after) };
    }
    case 'run': {
      const runs = mission.state === 'running' || mission.state === 'finished';
      const other = mission.state !== before?.mission.state;
      const left = before?.mission.waits_for_word === true && !mission.waits_for_word;
      return { obeyed: runs && (other || left), detail: is(after) };
    }
    case 'go_on': {
      const { state } = after.activity;
      return {
        obeyed: state !== 'held' && state !== 'failed',
        detail: `the mode is ${after.mode}`,
      };
    }
    case 'skip': {
      const moved = mission.current_item !== before?.mission.current_item;
      // It may have come to the end of that item by itself.
      return {
        obeyed: moved ? null : false,
        detail: `item ${mission.current_item ?? '—'} is in hand`,
      };
    }
    case 'home': {
      const obeyed = after.home !== null && distance_m(after.home, wish.at) < SAME_PLACE_M;
      return { obeyed, detail: obeyed ? 'home is there' : 'home is elsewhere' };
    }
    case 'stand':
      return stands(wish.at, before, after);
  }
};

const has = ({ mission }: Vehicle): string =>
  `“${mission.name ?? ''}” revision ${mission.revision ?? '—'} is loaded`;
const is = ({ mission }: Vehicle): string => `the mission is ${mission.state}`;
