// A command had no answer. Whether it was obeyed is not known until the robot is asked: this compares
// its state before and after.

import { metres } from './format';
import { distance_m } from './geo';
import { activity_line } from './modes';
import type { LatLon } from './plan';
import { say } from './say';
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
  if (!here) return { obeyed: false, detail: say('it_does_not_know_where_it_stands') };
  const off_m = distance_m(here, told);
  const there = robot_place(before);
  // It may have been there before; and what it saw there may have moved it already.
  const came = there === null || distance_m(there, told) >= TOLD_PLACE_M;
  const obeyed = off_m < TOLD_PLACE_M && came ? true : null;
  return { obeyed, detail: say('it_takes_itself_to_stand_off_from', { off: metres(off_m) }) };
};

/** @param before the state that the person acted upon; null: none was seen */
export const outcome = (wish: Wish, before: Vehicle | null, after: Vehicle): Outcome => {
  const { mission } = after;
  switch (wish.to) {
    case 'arm':
      return settled(after.armed, say('it_is_not_armed'), say('it_is_armed'));
    case 'reset':
      return settled(!after.estop, say('stop_still_latched'), say('stop_is_reset'));
    case 'acknowledge':
      return settled(!estimate_waits(after), say('it_still_waits_for_that'), say('it_was_taken'));
    case 'settle_shift':
      return settled(
        !shift_waits(after),
        say('it_still_asks_which_place_counts'),
        say('it_was_taken'),
      );
    case 'correct_antennas':
      return settled(
        !antennas_wait(after),
        say('they_are_still_not_used'),
        say('they_are_corrected'),
      );
    case 'mode':
      return { obeyed: after.mode === wish.mode, detail: mode_is(after) };
    case 'do': {
      const fresh = after.activity.id !== before?.activity.id;
      const obeyed = fresh && wish.kinds.includes(after.activity.kind);
      const line = activity_line(after);
      const words = line ? `${line.head.toLowerCase()}: ${line.detail.toLowerCase()}` : '';
      return { obeyed, detail: obeyed && line ? words : mode_is(after) };
    }
    case 'load': {
      const obeyed = mission.id === wish.id && mission.revision === wish.revision;
      return { obeyed, detail: mission.name === null ? say('no_mission_is_loaded') : has(after) };
    }
    case 'run': {
      const runs = mission.state === 'running' || mission.state === 'finished';
      const other = mission.state !== before?.mission.state;
      const left = before?.mission.waits_for_word === true && !mission.waits_for_word;
      return { obeyed: runs && (other || left), detail: is(after) };
    }
    case 'go_on':
      return { obeyed: !['held', 'failed'].includes(after.activity.state), detail: mode_is(after) };
    case 'skip': {
      const moved = mission.current_item !== before?.mission.current_item;
      // It may have come to the end of that item by itself.
      const at = mission.current_item ?? '—';
      return {
        obeyed: moved ? null : false,
        detail: say('item_current_item_is_in_hand', { current_item: at }),
      };
    }
    case 'home': {
      const obeyed = after.home !== null && distance_m(after.home, wish.at) < SAME_PLACE_M;
      return settled(obeyed, say('home_is_elsewhere'), say('home_is_there'));
    }
    case 'stand':
      return stands(wish.at, before, after);
  }
};

const mode_is = ({ mode }: Vehicle): string => say('the_mode_is_mode', { mode });
const has = ({ mission }: Vehicle): string =>
  say('name_revision_revision_is_loaded', {
    name: mission.name ?? '',
    revision: mission.revision ?? '—',
  });
const is = ({ mission }: Vehicle): string => say('the_mission_is_state', { state: mission.state });
