// A guided calibration drive, in words and figures a person can judge by.

import { number_text, UNKNOWN } from './format';
import type { LatLon } from './plan';
import { say, told } from './say';

export type CalibrationKind = 'drive' | 'steering' | 'compass' | 'antennas';
export interface CalibrationValue {
  readonly quantity: string;
  readonly unit: string;
  readonly before: number | null;
  readonly after: number | null;
  readonly sigma: number | null;
  readonly inside: boolean;
  readonly at_least: boolean;
  readonly keeps: boolean;
}
export interface CalibrationNeed {
  readonly kind: CalibrationKind;
  readonly possible: boolean;
  readonly reason: string;
  readonly space: {
    readonly ahead_m: number;
    readonly behind_m: number;
    readonly left_m: number;
    readonly right_m: number;
  };
  readonly seconds: number;
  readonly corners: readonly LatLon[];
}
/** The ground of one. */
export interface SpaceOnMap {
  readonly corners: readonly LatLon[];
  /** It can be begun there. */
  readonly possible: boolean;
}
export interface Calibration {
  readonly id: number;
  readonly state: 'none' | 'running' | 'done' | 'failed' | 'aborted';
  readonly kind: CalibrationKind | null;
  readonly reason: string;
  readonly step: 'stands' | 'straight' | 'turn' | 'circle' | null;
  readonly steps_done: number;
  readonly steps: number;
  readonly share: number;
  readonly left_s: number | null;
  readonly values: readonly CalibrationValue[];
  readonly kept: boolean;
  readonly kinds: readonly CalibrationNeed[];
}

export const kind_words: Readonly<Record<CalibrationKind, string>> = told({
  drive: 'how_it_drives',
  steering: 'its_steering',
  compass: 'its_compass',
  antennas: 'its_two_antennas',
});

export const step_words: Readonly<Record<NonNullable<Calibration['step']>, string>> = told({
  stands: 'stands',
  straight: 'drives_straight',
  turn: 'turns_on_the_spot',
  circle: 'drives_a_bend',
});

const titles: Readonly<Record<string, string>> = told({
  steering_delay: 'delay_of_turning',
  drive_delay: 'delay_of_driving',
  braking: 'braking',
  acceleration: 'speeding_up',
  speed_scale: 'way_over_ground',
  turn_scale: 'turn_over_ground',
  side_bias: 'bends_when_told_straight',
  steering_zero: 'wheels_when_told_straight',
  compass_offset: 'compass_is_off_by',
  compass_spread: 'what_is_left_by_heading',
  antennas_offset: 'antennas_are_off_by',
});
const digits: Readonly<Record<string, number>> = { s: 2, 'm/s²': 2, '1/m': 3, deg: 1, '': 3 };

export interface CalibrationRow {
  readonly quantity: string;
  readonly title: string;
  readonly before: string;
  readonly after: string;
  /** What a person should know of it; empty: nothing. */
  readonly note: string;
}

const note = ({ quantity, before, after, inside, at_least, keeps }: CalibrationValue): string => {
  if (after === null) return say('not_measured');
  if (!inside) return say('no_vehicle_is_so_not_kept');
  if (at_least) return say('as_it_was_told_more_was_not_asked');
  if (!keeps) return say('told_only');
  const harder = before !== null && after > before;
  const bounded = quantity === 'braking' || quantity === 'acceleration';
  return harder && bounded ? say('used_up_to_what_is_set') : '';
};

export const calibration_rows = ({ values }: Calibration): readonly CalibrationRow[] =>
  values.map((value) => {
    const places = digits[value.unit] ?? 2;
    const text = (x: number | null): string => number_text(x, places, value.unit);
    const sigma = value.sigma === null ? '' : ` ±${number_text(value.sigma, places)}`;
    return {
      quantity: value.quantity,
      title: titles[value.quantity] ?? value.quantity,
      before: text(value.before),
      after: value.after === null ? UNKNOWN : `${text(value.after)}${sigma}`,
      note: note(value),
    };
  });

/** At least one of them would act. */
export const worth_keeping = ({ state, values }: Calibration): boolean =>
  state === 'done' && values.some(({ inside, keeps }) => inside && keeps);

/** What acts from now on: "Kept, and used from now on: Braking, Delay of turning." */
export const kept_words = ({ values }: Calibration): string => {
  const used = values.filter(({ inside, keeps }) => inside && keeps);
  const names = used.map(({ quantity }) => titles[quantity] ?? quantity);
  return say('kept_and_used_from_now_on_names', { names: names.join(', ') });
};

/** "It needs 9 m ahead, 3 m behind and 2 m to either side, and about 2 minutes." */
export const need_words = ({ space, seconds }: CalibrationNeed): string => {
  const side = Math.max(space.left_m, space.right_m);
  const [ahead, behind, aside] = [space.ahead_m, space.behind_m, side].map((m) => Math.ceil(m));
  const time =
    seconds < 60 ? `${Math.round(seconds)} s` : `${Math.max(1, Math.round(seconds / 60))} min`;
  return say('it_needs_ahead_m_ahead_behind_m', { ahead, behind, aside, time });
};
