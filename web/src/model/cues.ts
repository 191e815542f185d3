// What is heard and felt of what happens on the robot, by somebody who looks at the robot and not at
// the screen. Each is unlike all others; most events are none.

import type { StationEvent } from './vehicle';

export type Cue = 'added' | 'removed' | 'cleared' | 'reached' | 'finished' | 'failsafe';

const PLAIN: Readonly<Record<string, Cue>> = {
  mission_item_added: 'added',
  mission_item_removed: 'removed',
  mission_cleared: 'cleared',
  item_reached: 'reached',
  reached: 'reached',
  mission_finished: 'finished',
};
/** It stands, or is about to, and nobody here has asked for it. */
const FAILSAFES: ReadonlySet<string> = new Set([
  'mission_paused',
  'mission_aborted',
  'stopped',
  'estop',
  'blocked',
  'fence',
  'cross_track_lost',
  'estimate_latched',
  'activity_held',
  'base_left_control',
  'base_not_following',
  'disarmed',
  'returning',
]);

/** Null: nothing is heard. Whoever paused or stopped it themselves (level info) knows it. */
export const cue_of = ({ kind, level }: Pick<StationEvent, 'kind' | 'level'>): Cue | null =>
  level !== 'info' && FAILSAFES.has(kind) ? 'failsafe' : (PLAIN[kind] ?? null);

/** Milliseconds of vibration and pause in turn. */
export const vibration_of: Readonly<Record<Cue, readonly number[]>> = {
  added: [60],
  removed: [60, 60, 60],
  cleared: [200, 60, 200],
  reached: [120],
  finished: [120, 80, 120, 80, 400],
  failsafe: [500, 120, 500, 120, 500],
};

/** Hz and seconds, one note after the other: up is more, down is less. */
export const notes_of: Readonly<Record<Cue, readonly (readonly [hz: number, s: number])[]>> = {
  added: [
    [660, 0.07],
    [880, 0.1],
  ],
  removed: [
    [880, 0.07],
    [660, 0.1],
  ],
  cleared: [
    [880, 0.07],
    [660, 0.07],
    [440, 0.16],
  ],
  reached: [[1050, 0.12]],
  finished: [
    [523, 0.12],
    [659, 0.12],
    [784, 0.12],
    [1047, 0.3],
  ],
  failsafe: [
    [880, 0.16],
    [587, 0.16],
    [880, 0.16],
    [587, 0.16],
    [880, 0.16],
    [587, 0.3],
  ],
};

export interface CueSettings {
  readonly sound: boolean;
  readonly vibration: boolean;
  /** The event's own words are read aloud. */
  readonly speech: boolean;
}
export const CUE_DEFAULTS: CueSettings = { sound: true, vibration: true, speech: false };

/** What was kept on the device. */
export const cue_settings_of = (kept: unknown): CueSettings => {
  const all = typeof kept === 'object' && kept !== null ? (kept as Record<string, unknown>) : {};
  const flag = (name: keyof CueSettings): boolean => {
    const value = all[name];
    return typeof value === 'boolean' ? value : CUE_DEFAULTS[name];
  };
  return { sound: flag('sound'), vibration: flag('vibration'), speech: flag('speech') };
};
