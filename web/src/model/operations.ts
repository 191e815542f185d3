// Which command makes sense now, and if not, why: one sentence for the button. The page refuses only
// what it can know for certain; the last word is the robot's answer. Whatever makes the robot stop
// is never refused here.

import { antennas_wait, estimate_waits, shift_waits, type Mode, type Vehicle } from './vehicle';

export interface Facts {
  /** What is shown is old, or of unknown age. */
  readonly link_stale: boolean;
  /** It is old although messages come. */
  readonly link_late?: boolean;
  readonly vehicle: Vehicle | null;
}

type Reason = string | null;

/** Modes that the person drives, by pad or radio. */
const STICKS: ReadonlySet<Mode> = new Set(['MANUAL', 'STEERING', 'ACRO', 'SIMPLE']);
export const by_hand = (mode: Mode | undefined): boolean => mode !== undefined && STICKS.has(mode);

export const no_link = ({ link_stale, link_late, vehicle }: Facts): Reason => {
  if (!link_stale && vehicle !== null) return null;
  return link_late === true && vehicle !== null
    ? 'What you see is too old to act upon: the link is slow.'
    : 'No live connection to the robot.';
};

const no_stop = ({ vehicle }: Facts): Reason =>
  vehicle?.estop === true ? 'The emergency stop is latched: reset it first.' : null;

export const why_not_arm = (facts: Facts): Reason => no_link(facts) ?? no_stop(facts);

export const why_not_reset_stop = (facts: Facts): Reason =>
  no_link(facts) ?? (facts.vehicle?.estop === true ? null : 'The emergency stop is not set.');

export const why_not_acknowledge = (facts: Facts): Reason =>
  no_link(facts) ??
  (facts.vehicle && estimate_waits(facts.vehicle) ? null : 'There is nothing to look at.');

export const why_not_settle_shift = (facts: Facts): Reason =>
  no_link(facts) ??
  (facts.vehicle && shift_waits(facts.vehicle) ? null : 'The positions have not moved.');

export const why_not_correct_antennas = (facts: Facts): Reason =>
  no_link(facts) ??
  (facts.vehicle && antennas_wait(facts.vehicle) ? null : 'The antennas are not askew.');

export const why_not_mode = (facts: Facts, mode: string): Reason => {
  if (mode === 'HOLD') return null;
  return no_link(facts) ?? no_stop(facts);
};

/** @param saved what the editor holds is stored, unchanged */
export const why_not_load = (facts: Facts, saved: boolean, items: number): Reason => {
  if (items === 0) return 'The mission has no items yet.';
  const link = no_link(facts);
  if (link !== null) return link;
  if (!saved) return 'Save the mission first: the robot takes the stored revision.';
  const state = facts.vehicle?.mission.state;
  return state === 'running' ? 'A mission is running: stop it first.' : null;
};

export const why_not_start = (facts: Facts): Reason => {
  const before = no_link(facts) ?? no_stop(facts);
  if (before !== null) return before;
  const state = facts.vehicle?.mission.state;
  if (state === 'idle') return 'Load a mission first.';
  if (state === 'running') return 'The mission is running already.';
  return facts.vehicle?.armed === true ? null : 'Arm the robot first.';
};

export const why_not_pause = (facts: Facts): Reason => {
  const state = facts.vehicle?.mission.state;
  return state === 'running' ? null : 'No mission is running.';
};

/** It stands in the middle of its mission: paused, or blocked by what it could not do. */
export const waits = ({ vehicle }: Facts): boolean =>
  vehicle?.mission.state === 'paused' || vehicle?.mission.state === 'blocked';

/** It runs, but stays at a place without a time: until somebody says to go on. */
export const waits_for_word = ({ vehicle }: Facts): boolean =>
  vehicle?.mission.state === 'running' && vehicle.mission.waits_for_word;

export const why_not_resume = (facts: Facts): Reason => {
  const before = no_link(facts) ?? no_stop(facts);
  if (before !== null) return before;
  return waits(facts) || waits_for_word(facts) ? null : 'The mission is not paused.';
};

export const why_not_stop_mission = (facts: Facts): Reason => {
  const state = facts.vehicle?.mission.state;
  return state === 'running' || state === 'paused' || state === 'blocked'
    ? null
    : 'No mission is running or paused.';
};

export const why_not_skip = (facts: Facts): Reason => no_link(facts) ?? why_not_stop_mission(facts);

export const why_not_drive = (facts: Facts): Reason => {
  const before = no_link(facts) ?? no_stop(facts);
  if (before !== null) return before;
  if (facts.vehicle?.armed !== true) return 'Arm the robot first.';
  return by_hand(facts.vehicle.mode) ? null : 'Choose the mode MANUAL first.';
};
