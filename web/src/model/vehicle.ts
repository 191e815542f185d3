// The state of the vehicle as the stream sends it, and the words for it. An unknown value is null
// and is shown as "—", never as zero.

import type { Obstacle } from './obstacle';
import type { RowDriven } from './row';
import type { LatLon } from './plan';
import { say, told } from './say';
import type { MapPlace } from './site_map';
import type { Twist } from './sweep';

export type Mode =
  | 'MANUAL'
  | 'HOLD'
  | 'AUTO'
  | 'GUIDED'
  | 'RTL'
  | 'SMART_RTL'
  | 'FOLLOW'
  | 'STEERING'
  | 'ACRO'
  | 'SIMPLE'
  | 'DOCK'
  | 'LOITER'
  | 'CIRCLE';
export type Fix = 'none' | 'unknown' | 'estimated' | 'gps' | 'dgps' | 'rtk_float' | 'rtk_fixed';
export type Control = 'none' | 'auto' | 'teleop' | 'rc';
export type ExecutionState =
  'idle' | 'loaded' | 'running' | 'paused' | 'blocked' | 'finished' | 'aborted';

/** Every measured group carries its age at the time the message was sent. */
export interface Measured {
  readonly age_s: number | null;
  readonly stale: boolean;
}
export interface Position extends Measured {
  readonly lat: number | null;
  readonly lon: number | null;
  readonly heading_deg: number | null;
  readonly speed_mps: number | null;
  readonly horizontal_accuracy_m: number | null;
  readonly heading_accuracy_deg: number | null;
  /** Where it is with one sigma; the orientation is the compass direction of the longer axis. */
  readonly ellipse: {
    readonly major_m: number;
    readonly minor_m: number;
    readonly orientation_deg: number;
  } | null;
  readonly source: string | null;
}
export interface Gnss extends Measured {
  readonly fix: Fix;
  readonly lat: number | null;
  readonly lon: number | null;
  readonly satellites: number | null;
  readonly hdop: number | null;
  readonly horizontal_accuracy_m: number | null;
  readonly correction_age_s: number | null;
}
export interface Attitude extends Measured {
  /** Right side down positive. */
  readonly roll_deg: number | null;
  /** Nose up positive. */
  readonly pitch_deg: number | null;
}
export interface Battery extends Measured {
  readonly battery_v: number | null;
  readonly charge_pct: number | null;
  readonly fault: boolean | null;
}
/** How the robot finds out where it is and which way it faces. */
export interface Estimator {
  readonly alignment: 'unknown' | 'aligning' | 'aligned';
  /** What a driver can do for a better heading. */
  readonly advice: string | null;
  readonly gyro_bias_dps: number | null;
  readonly compass_bias_deg: number | null;
  readonly odometry_scale: number | null;
  /** Metres to its left for each metre ahead. */
  readonly side_slip: number | null;
  /** Measurements that were not believed, by kind. */
  readonly rejected: Readonly<Record<string, number>>;
  readonly resets: number;
}
/** How the vehicle answers, learned while it drives, beside what was set. */
export interface Learned {
  readonly delay_s: number | null;
  readonly delay_set_s: number;
  readonly delay_used_s: number;
  readonly braking_mps2: number | null;
  readonly braking_set_mps2: number;
  readonly braking_used_mps2: number;
  /** Seen since it was armed. */
  readonly braking_proved: boolean;
}
type Switch = 'up' | 'middle' | 'down' | 'unknown' | null;
export interface Rc extends Measured {
  readonly lost: boolean | null;
  readonly swa: Switch;
  readonly swb: Switch;
  readonly swc: Switch;
  readonly swd: Switch;
  /** Knob, −1 to 1. */
  readonly vra: number | null;
  /** What they do as they stand, in words. */
  readonly meaning: Readonly<Record<'swa' | 'swb' | 'swc' | 'swd' | 'vra', string | null>>;
}
export interface Base extends Measured {
  readonly errors: readonly string[];
}
/** What an item by sight is driven by right now. */
export interface Lead {
  readonly what: 'row' | 'wall' | 'landmarks' | 'tag';
  /** Null: it is looked for, or remembered. */
  readonly source: 'scan' | 'vision' | 'both' | null;
  readonly by: 'auto' | 'scan' | 'vision';
}
export interface MissionProgress {
  readonly id: string | null;
  readonly revision: number | null;
  readonly name: string | null;
  readonly state: ExecutionState;
  readonly reason: string;
  /** It stays at a place until somebody says to go on. */
  readonly waits_for_word: boolean;
  readonly lead: Lead | null;
  /** From 1; null: none. */
  readonly current_item: number | null;
  readonly items: number;
  readonly distance_to_item_m: number | null;
  readonly bearing_to_item_deg: number | null;
  readonly cross_track_m: number | null;
  /** Within it the item in hand counts as reached. */
  readonly arrival_radius_m: number | null;
  /** Farther off its way the mission pauses. */
  readonly cross_track_limit_m: number | null;
  readonly distance_left_m: number | null;
  readonly eta_s: number | null;
}
/** What a mode other than AUTO does, or did last. */
export interface Activity {
  /** Another number: it was replaced. */
  readonly id: number;
  readonly kind:
    | 'goto'
    | 'heading'
    | 'move'
    | 'turn'
    | 'return'
    | 'retrace'
    | 'follow'
    | 'dock'
    | 'loiter'
    | 'circle'
    | 'calibration'
    | null;
  readonly state: 'none' | 'driving' | 'turning' | 'waiting' | 'held' | 'reached' | 'failed';
  /** Why waiting or failed. */
  readonly reason: string;
  readonly goal: LatLon | null;
  readonly goal_heading_deg: number | null;
  /** Of CIRCLE; of LOITER: farther away it drives back. */
  readonly radius_m: number | null;
  /** Of CIRCLE; null: without end. */
  readonly turns: number | null;
  readonly clockwise: boolean | null;
  readonly distance_m: number | null;
  /** Left to turn, clockwise positive. */
  readonly turn_deg: number | null;
  /** Of FOLLOW. */
  readonly target: LatLon | null;
}
/** The recording of a driven way. */
export interface TeachBrief {
  readonly state: 'loading' | 'idle' | 'recording' | 'paused' | 'interrupted';
  readonly points: number;
  readonly length_m: number;
}
/** The fence that the robot keeps to. */
export interface FenceState {
  readonly name: string;
  readonly inside: boolean;
  /** To the nearest limit; negative outside. */
  readonly distance_m: number | null;
}
export interface SafetyCondition {
  readonly id: string;
  readonly detail: string;
}
export interface Vehicle {
  readonly name: string;
  readonly time: string;
  readonly mode: Mode;
  readonly armed: boolean;
  readonly estop: boolean;
  readonly control: Control;
  /** Sticks over the stream: whether one may act, and what helps. */
  readonly teleop: {
    readonly state: 'off' | 'release' | 'ready' | 'held';
    readonly reason: string;
    readonly delay_s: number | null;
    /** Of its speed, what drives by itself is allowed by a hand; 0: it was let go; null: nobody uses one. */
    readonly auto_share?: number | null;
  };
  readonly speed_reason: string;
  readonly position: Position;
  /** In the map in use. */
  readonly place?: MapPlace;
  readonly estimator: Estimator;
  readonly learned: Learned;
  readonly attitude: Attitude;
  readonly gnss: Gnss;
  readonly base: Base;
  readonly battery: Battery;
  readonly rc: Rc;
  readonly mission: MissionProgress;
  readonly activity: Activity;
  readonly fence: FenceState | null;
  readonly teach?: TeachBrief;
  readonly safety: readonly SafetyCondition[];
  /** What was sent to the vehicle. */
  readonly command?: Twist;
  /** What limits the drive, or stops it. */
  readonly obstacle?: Obstacle | null;
  readonly row?: RowDriven | null;
  /** The way around it: latitudes and longitudes. */
  readonly detour?: readonly (readonly number[])[] | null;
  readonly home: LatLon | null;
  readonly ready_to_arm: boolean;
}
export interface Check {
  readonly id: string;
  readonly ok: boolean;
  readonly severity: 'info' | 'warning' | 'error';
  readonly detail: string;
}
export type { Capabilities } from './capabilities';
/** Dense points that are driven as one smooth way. */
export interface SmoothedItems {
  readonly first_item: number;
  readonly last_item: number;
  /** The way passes beside them by no more. */
  readonly deviation_m: number;
}
/** What `start` would do; nothing has moved yet. */
export interface Preview {
  readonly mission_id: string;
  readonly revision: number;
  readonly name: string;
  readonly first_item: number;
  readonly first_target: LatLon | null;
  /** It goes on from where it stands, so far after the begin of its way; null: it drives to first_item. */
  readonly joins_after_m: number | null;
  readonly left_out: number;
  readonly distance_m: number | null;
  readonly bearing_deg: number | null;
  readonly speed_mps: number;
  readonly at_end: 'hold' | 'return' | 'repeat' | 'back_and_forth';
}
export interface StationEvent {
  readonly time: string;
  readonly level: 'info' | 'warning' | 'error';
  readonly kind: string;
  readonly detail: string;
}

export const fix_words: Record<Fix, string> = told({
  none: 'no_fix',
  unknown: 'fix_unknown',
  estimated: 'dead_reckoning',
  gps: 'gnss_caps',
  dgps: 'dgnss_caps',
  rtk_float: 'rtk_float',
  rtk_fixed: 'rtk_fixed',
});

/** How good a fix is for driving along rows. */
export const fix_tone = (fix: Fix | undefined): 'plain' | 'good' | 'bad' => {
  switch (fix) {
    case 'rtk_fixed':
      return 'good';
    case 'none':
    case 'estimated':
      return 'bad';
    case 'unknown':
    case 'gps':
    case 'dgps':
    case 'rtk_float':
    case undefined:
      return 'plain';
  }
};

/** The receiver tells places, and the robot goes by something else: by its tracks, or by a map. */
export const fix_unused = ({ position, gnss }: Vehicle): boolean =>
  gnss.fix !== 'none' &&
  gnss.fix !== 'unknown' &&
  position.source !== null &&
  !position.source.startsWith('gnss');

export const control_words: Record<Control, string> = told({
  none: 'nobody_drives',
  auto: 'autopilot_drives',
  teleop: 'page_drives',
  rc: 'radio_drives',
});

/** The same in one word, for narrow places. */
export const driver_words: Record<Control, string> = told({
  none: 'nobody',
  auto: 'autopilot',
  teleop: 'page',
  rc: 'radio',
});

export const state_words: Record<ExecutionState, string> = told({
  idle: 'no_mission_loaded',
  loaded: 'loaded',
  running: 'running',
  paused: 'paused',
  blocked: 'blocked_2',
  finished: 'finished',
  aborted: 'aborted',
});

export interface RadioLine {
  readonly name: string;
  readonly position: string;
  readonly meaning: string;
}

/** The switches and the knob that do something; none of a radio that was never heard. */
export const radio_lines = (rc: Rc | undefined): readonly RadioLine[] => {
  const lines: RadioLine[] = [];
  for (const name of ['swa', 'swb', 'swc', 'swd', 'vra'] as const) {
    const meaning = rc?.meaning[name] ?? null;
    const at = rc?.[name] ?? null;
    if (meaning === null || at === null) continue;
    const position =
      typeof at === 'number' ? say('at_at_percent', { at: Math.round(at * 100) }) : at;
    lines.push({ name: name.toUpperCase(), position, meaning });
  }
  return lines;
};

/** Where the receiver says it is, or null without a fresh fix. */
export const receiver_place = (vehicle: Vehicle): LatLon | null => {
  const { lat, lon, stale, fix } = vehicle.gnss;
  return lat === null || lon === null || stale || fix === 'none' ? null : { lat, lon };
};

/** Where the robot believes it is, or null while it does not know. */
export const robot_place = (vehicle: Vehicle | null): LatLon | null => {
  const { lat, lon } = vehicle?.position ?? { lat: null, lon: null };
  return lat === null || lon === null ? null : { lat, lon };
};

export const teach_words: Record<TeachBrief['state'], string> = told({
  loading: 'one_moment',
  idle: 'off',
  recording: 'recording',
  paused: 'paused',
  interrupted: 'interrupted',
});

/** The position was set anew so far that the robot holds until a person has looked. */
/** The receiver's positions moved for good: a person says which place counts. */
export const shift_waits = (vehicle: Vehicle): boolean =>
  vehicle.safety.some(({ id }) => id === 'base_moved');

/** Two antennas are mounted askew, and the offset waits to be confirmed. */
export const antennas_wait = (vehicle: Vehicle): boolean =>
  vehicle.safety.some(({ id }) => id === 'antennas_askew');

export const estimate_waits = (vehicle: Vehicle): boolean =>
  vehicle.safety.some(({ id }) => id === 'estimate_latched');
