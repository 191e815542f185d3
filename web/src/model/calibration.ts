// A guided calibration drive, in words and figures a person can judge by.

import { number_text, UNKNOWN } from './format';
import type { LatLon } from './plan';

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

export const kind_words: Readonly<Record<CalibrationKind, string>> = {
  drive: 'How it drives',
  steering: 'Its steering',
  compass: 'Its compass',
  antennas: 'Its two antennas',
};

export const step_words: Readonly<Record<NonNullable<Calibration['step']>, string>> = {
  stands: 'stands',
  straight: 'drives straight',
  turn: 'turns on the spot',
  circle: 'drives a bend',
};

const titles: Readonly<Record<string, string>> = {
  steering_delay: 'Delay of turning',
  drive_delay: 'Delay of driving',
  braking: 'Braking',
  acceleration: 'Speeding up',
  speed_scale: 'Way over ground',
  turn_scale: 'Turn over ground',
  side_bias: 'Bends when told straight',
  steering_zero: 'Wheels when told straight',
  compass_offset: 'Compass is off by',
  compass_spread: 'What is left by heading',
  antennas_offset: 'Antennas are off by',
};
const digits: Readonly<Record<string, number>> = { s: 2, 'm/s²': 2, '1/m': 3, deg: 1, '': 3 };

export interface CalibrationRow {
  readonly title: string;
  readonly before: string;
  readonly after: string;
  /** What a person should know of it; empty: nothing. */
  readonly note: string;
}

const note = ({ quantity, before, after, inside, at_least, keeps }: CalibrationValue): string => {
  if (after === null) return 'not measured';
  if (!inside) return 'no vehicle is so: not kept';
  if (at_least) return 'as it was told: more was not asked';
  if (!keeps) return 'told only';
  const harder = before !== null && after > before;
  const bounded = quantity === 'braking' || quantity === 'acceleration';
  return harder && bounded ? 'used up to what is set' : '';
};

export const calibration_rows = ({ values }: Calibration): readonly CalibrationRow[] =>
  values.map((value) => {
    const places = digits[value.unit] ?? 2;
    const text = (x: number | null): string => number_text(x, places, value.unit);
    const sigma = value.sigma === null ? '' : ` ±${number_text(value.sigma, places)}`;
    return {
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
  return `Kept, and used from now on: ${names.join(', ')}.`;
};

/** "It needs 9 m ahead, 3 m behind and 2 m to either side, and about 2 minutes." */
export const need_words = ({ space, seconds }: CalibrationNeed): string => {
  const side = Math.max(space.left_m, space.right_m);
  const [ahead, behind, aside] = [space.ahead_m, space.behind_m, side].map((m) => Math.ceil(m));
  const time =
    seconds < 60 ? `${Math.round(seconds)} s` : `${Math.max(1, Math.round(seconds / 60))} min`;
  return `It needs ${ahead} m ahead, ${behind} m behind and ${aside} m to either side, and about ${time}.`;
};
