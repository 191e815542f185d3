// The guide through a calibration drive: what each kind is for, what it needs, what its figures mean, and what
// helps where it failed.

import type { Calibration, CalibrationKind, CalibrationNeed } from './calibration';
import { accuracy, degrees_text, UNKNOWN } from './format';
import { say, say_plain, told, type PlainKey } from './say';
import type { Vehicle } from './vehicle';

export const purpose_words: Readonly<Record<CalibrationKind, string>> = told({
  drive: 'purpose_drive',
  steering: 'purpose_steering',
  compass: 'purpose_compass',
  antennas: 'purpose_antennas',
});
export const figure_words: Readonly<Record<CalibrationKind, string>> = told({
  drive: 'figure_drive',
  steering: 'figure_steering',
  compass: 'figure_compass',
  antennas: 'figure_antennas',
});

export const STAGES = ['prepare', 'drive', 'judge'] as const;
export type Stage = (typeof STAGES)[number];
export const stage_words: Readonly<Record<Stage, string>> = told({
  prepare: 'stage_prepare',
  drive: 'stage_drive',
  judge: 'stage_judge',
});
export const stage_of = (state: Calibration['state']): Stage =>
  state === 'none' ? 'prepare' : state === 'running' ? 'drive' : 'judge';

export interface Readiness {
  readonly subject: string;
  readonly well: boolean;
  readonly words: string;
}
/** The server's limits: calibration.cpp. 14° are a quarter of a radian. */
const POSITION_M = 0.3;
const HEADING_DEG = 14;

const measured = (
  subject: string,
  value: number | null,
  most: number,
  text: (value: number) => string,
): Readiness => {
  const well = value !== null && value <= most;
  const now = value === null ? UNKNOWN : text(value);
  return { subject, well, words: well ? now : say('ready_at_most', { now, most: text(most) }) };
};

/** What the page can see of it, before it begins. */
export const readiness = (need: CalibrationNeed, vehicle: Vehicle): readonly Readiness[] => {
  const { armed, position } = vehicle;
  const known = (value: number | null): number | null => (position.stale ? null : value);
  const fits = need.possible || !leaves_fence(need.reason);
  return [
    measured(say('position'), known(position.horizontal_accuracy_m), POSITION_M, accuracy),
    measured(
      say('heading'),
      known(position.heading_accuracy_deg),
      HEADING_DEG,
      (deg) => `±${degrees_text(deg)}`,
    ),
    {
      subject: say('ready_ground'),
      well: fits,
      words: say(fits ? 'ready_fits' : 'ready_does_not_fit'),
    },
    {
      subject: say('armed'),
      well: armed,
      words: armed ? say('word_yes') : say('arm_the_robot_first'),
    },
  ];
};

/** By words of the robot's reason, the first that fits. */
const CURES: readonly (readonly [RegExp, PlainKey])[] = [
  [/\bfence\b/, 'fail_fence'],
  [/\bheading is not known\b/, 'fail_heading'],
  [/\bdiffer\b|\bcontradict|\bcannot be told\b/, 'fail_contradict'],
  [/\bposition\b|\bGNSS\b|\breceiver\b/, 'fail_position'],
  [/\bslow/, 'fail_slowed'],
  [/\bleft the space\b/, 'fail_space'],
  [/\bleans\b/, 'fail_slope'],
  [/\bwhat it is told\b|\bturn on the spot\b/, 'fail_obeys'],
];
const leaves_fence = (reason: string): boolean => /\bfence\b/.test(reason);

/** What a person can do about it; null: nothing that this page knows. */
export const cure_of = (reason: string): string | null => {
  const [, cure] = CURES.find(([words]) => words.test(reason)) ?? [];
  return cure === undefined ? null : say_plain(cure);
};

const meanings: Readonly<Record<string, string>> = told({
  steering_delay: 'mean_turn_delay',
  drive_delay: 'mean_drive_delay',
  braking: 'mean_braking',
  acceleration: 'mean_acceleration',
  speed_scale: 'mean_speed_scale',
  turn_scale: 'mean_turn_scale',
  side_bias: 'mean_side_bias',
  steering_zero: 'mean_steering_zero',
  compass_offset: 'mean_compass_offset',
  compass_spread: 'mean_compass_spread',
  antennas_offset: 'mean_antennas_offset',
});
/** "by how much it slows each second"; empty: this page does not know it. */
export const meaning_of = (quantity: string): string =>
  Object.hasOwn(meanings, quantity) ? (meanings[quantity] ?? '') : '';
