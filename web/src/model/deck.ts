// The four figures that one reads while it drives, at arm's length: a large number, and beside it
// what it is a number of.

import { duration, metres, side_word, UNKNOWN } from './format';
import { say } from './say';
import { speed_text, type SpeedUnit } from './settings';
import type { MissionProgress, Vehicle } from './vehicle';

export interface DeckFigure {
  readonly label: string;
  /** The number alone. */
  readonly value: string;
  readonly unit: string;
  /** Of a distance from the path: a word of some languages has no room beside the unit. */
  readonly side: { readonly word: string; readonly arrow: '◂' | '▸' } | null;
  readonly tone: 'plain' | 'warn' | 'bad';
}

/** Of the limit at which the mission pauses. */
const NEAR_LIMIT = 0.5;

/** "12.3 m" → number and unit; what is not known has none. */
const split = (text: string): readonly [value: string, unit: string] => {
  const [value = UNKNOWN, ...unit] = text.split(' ');
  return [value, unit.join(' ')];
};

const side_of = (left_m: number | null): DeckFigure['side'] =>
  left_m === null || left_m === 0
    ? null
    : { word: side_word(left_m), arrow: left_m > 0 ? '◂' : '▸' };

const figure = (label: string, [value, unit]: readonly [string, string]): DeckFigure => ({
  label,
  value,
  unit,
  side: null,
  tone: 'plain',
});

const path_tone = ({ cross_track_m, cross_track_limit_m }: MissionProgress): DeckFigure['tone'] => {
  if (cross_track_m === null || cross_track_limit_m === null) return 'plain';
  const share = Math.abs(cross_track_m) / cross_track_limit_m;
  return share >= 1 ? 'bad' : share >= NEAR_LIMIT ? 'warn' : 'plain';
};

/** A clock reads faster than words: "45" s, "3:05" min, "1:12" h. */
const clock_of = (seconds: number | null): readonly [value: string, unit: string] => {
  if (seconds === null || Number.isNaN(seconds)) return [UNKNOWN, ''];
  const whole = Math.round(seconds);
  if (whole < 60) return split(duration(whole));
  const pair = (value: number): string => String(value).padStart(2, '0');
  if (whole < 3600) return [`${Math.floor(whole / 60)}:${pair(whole % 60)}`, 'min'];
  return [`${Math.floor(whole / 3600)}:${pair(Math.floor((whole % 3600) / 60))}`, 'h'];
};

/** Always four, in the same order: what is not known is "—", and nothing moves. */
export const deck_figures = (
  vehicle: Vehicle | null,
  speed_in: SpeedUnit = 'm/s',
): readonly DeckFigure[] => {
  const mission = vehicle?.mission ?? null;
  const off_m = mission?.cross_track_m ?? null;
  const [off, off_unit] = split(metres(off_m === null ? null : Math.abs(off_m)));
  // Of one that has ended there is nothing left; how long one stands that is blocked nobody knows.
  const ended = mission?.state === 'finished' || mission?.state === 'aborted';
  const waits = vehicle?.obstacle?.blocked === true;
  return [
    figure(say('speed'), split(speed_text(vehicle?.position.speed_mps, speed_in))),
    {
      label: say('off_path'),
      value: off,
      unit: off_unit,
      side: side_of(off_m),
      tone: mission ? path_tone(mission) : 'plain',
    },
    figure(say('to_drive'), split(metres(ended ? null : mission?.distance_left_m))),
    figure(say('time_left'), clock_of(ended || waits ? null : (mission?.eta_s ?? null))),
  ];
};
