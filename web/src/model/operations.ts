// Which command makes sense now, and if not, why: one sentence for the button. The page refuses only
// what it can know for certain; the last word is the robot's answer. Whatever makes the robot stop
// is never refused here.

import { say } from './say';
import {
  antennas_wait,
  estimate_waits,
  shift_waits,
  type Check,
  type Mode,
  type Vehicle,
} from './vehicle';

export interface Facts {
  /** What is shown is old, or of unknown age. */
  readonly link_stale: boolean;
  /** It is old although messages come. */
  readonly link_late?: boolean;
  readonly vehicle: Vehicle | null;
  /** Why what acts on the robot would be refused: somebody else has control, or nobody. */
  readonly no_control?: string | null;
}

type Reason = string | null;

/** Modes that the person drives, by pad or radio. */
const STICKS: ReadonlySet<Mode> = new Set(['MANUAL', 'STEERING', 'ACRO', 'SIMPLE']);
export const by_hand = (mode: Mode | undefined): boolean => mode !== undefined && STICKS.has(mode);

export const no_link = ({ link_stale, link_late, vehicle }: Facts): Reason => {
  if (!link_stale && vehicle !== null) return null;
  return link_late === true && vehicle !== null
    ? say('what_you_see_is_too_old_to_act_upon')
    : say('no_live_connection_to_the_robot');
};

/** For what needs control: nothing that stops or holds does. */
export const out_of_reach = (facts: Facts): Reason => no_link(facts) ?? facts.no_control ?? null;

const no_stop = ({ vehicle }: Facts): Reason =>
  vehicle?.estop === true ? say('the_emergency_stop_is_latched_reset') : null;

/** Nothing speaks against arming but that the position is not known: who drives by hand sees it. */
export const only_position_fails = (checks: readonly Check[]): boolean => {
  const failing = checks.filter(({ ok, severity }) => !ok && severity === 'error');
  return (
    failing.length > 0 && failing.every(({ id }) => id === 'gnss_fix' || id === 'position_accuracy')
  );
};

export const why_not_arm = (facts: Facts): Reason => out_of_reach(facts) ?? no_stop(facts);

export const why_not_reset_stop = (facts: Facts): Reason =>
  out_of_reach(facts) ??
  (facts.vehicle?.estop === true ? null : say('the_emergency_stop_is_not_set'));

export const why_not_acknowledge = (facts: Facts): Reason =>
  out_of_reach(facts) ??
  (facts.vehicle && estimate_waits(facts.vehicle) ? null : say('there_is_nothing_to_look_at'));

export const why_not_settle_shift = (facts: Facts): Reason =>
  out_of_reach(facts) ??
  (facts.vehicle && shift_waits(facts.vehicle) ? null : say('the_positions_have_not_moved'));

export const why_not_correct_antennas = (facts: Facts): Reason =>
  out_of_reach(facts) ??
  (facts.vehicle && antennas_wait(facts.vehicle) ? null : say('the_antennas_are_not_askew'));

export const why_not_mode = (facts: Facts, mode: string): Reason => {
  if (mode === 'HOLD') return null;
  return out_of_reach(facts) ?? no_stop(facts);
};

/** @param saved what the editor holds is stored, unchanged */
export const why_not_load = (facts: Facts, saved: boolean, items: number): Reason => {
  if (items === 0) return say('the_mission_has_no_items_yet');
  const link = out_of_reach(facts);
  if (link !== null) return link;
  if (!saved) return say('save_the_mission_first_the_robot');
  const state = facts.vehicle?.mission.state;
  return state === 'running' ? say('a_mission_is_running_stop_it_first') : null;
};

export const why_not_start = (facts: Facts): Reason => {
  const before = out_of_reach(facts) ?? no_stop(facts);
  if (before !== null) return before;
  const state = facts.vehicle?.mission.state;
  if (state === 'idle') return say('load_a_mission_first');
  if (state === 'running') return say('the_mission_is_running_already');
  return facts.vehicle?.armed === true ? null : say('arm_the_robot_first');
};

export const why_not_pause = (facts: Facts): Reason => {
  const state = facts.vehicle?.mission.state;
  return state === 'running' ? null : say('no_mission_is_running');
};

/** It stands in the middle of its mission: paused, or blocked by what it could not do. */
export const waits = ({ vehicle }: Facts): boolean =>
  vehicle?.mission.state === 'paused' || vehicle?.mission.state === 'blocked';

/** It runs, but stays at a place without a time: until somebody says to go on. */
export const waits_for_word = ({ vehicle }: Facts): boolean =>
  vehicle?.mission.state === 'running' && vehicle.mission.waits_for_word;

export const why_not_resume = (facts: Facts): Reason => {
  const before = out_of_reach(facts) ?? no_stop(facts);
  if (before !== null) return before;
  return waits(facts) || waits_for_word(facts) ? null : say('the_mission_is_not_paused');
};

export const why_not_stop_mission = (facts: Facts): Reason => {
  const state = facts.vehicle?.mission.state;
  return state === 'running' || state === 'paused' || state === 'blocked'
    ? null
    : say('no_mission_is_running_or_paused');
};

export const why_not_skip = (facts: Facts): Reason =>
  out_of_reach(facts) ?? why_not_stop_mission(facts);

export const why_not_drive = (facts: Facts): Reason => {
  const before = out_of_reach(facts) ?? no_stop(facts);
  if (before !== null) return before;
  if (facts.vehicle?.armed !== true) return say('arm_the_robot_first');
  return by_hand(facts.vehicle.mode) ? null : say('choose_the_mode_manual_first');
};
