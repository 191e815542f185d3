// How sure the robot is of place and heading, and how fresh its corrections are, as lights.

import { accuracy, age, degrees_text, UNKNOWN } from './format';
import type { Light } from './instruments';
import type { Measured, Vehicle } from './vehicle';

export const SURE_OF = ['position', 'heading', 'corrections'] as const;
export interface Sureness {
  readonly of: (typeof SURE_OF)[number];
  readonly words: string;
  readonly light: Light;
}

interface Limits {
  readonly good: number;
  readonly warn: number;
}
/** Rows and survey lines at best, then a field way. */
const POSITION_M: Limits = { good: 0.05, warn: 0.3 };
/** Two degrees are 3.5 cm after a metre; beyond ten the robot creeps at first. */
export const HEADING_DEG: Limits = { good: 2, warn: 10 };
/** Receivers lose their fix after about half a minute without. */
const CORRECTIONS_S: Limits = { good: 5, warn: 30 };

const light_of = (value: number, { good, warn }: Limits): Light =>
  value <= good ? 'good' : value <= warn ? 'warn' : 'bad';

/** @param is_old of a group: what it said last is no claim about now */
export const sureness_of = (
  { position, gnss }: Vehicle,
  is_old: (group: Measured) => boolean,
): Sureness[] => {
  const one = (
    of: Sureness['of'],
    group: Measured,
    value: number | null,
    limits: Limits,
    words: (value: number) => string,
  ): Sureness => {
    if (value === null) return { of, words: UNKNOWN, light: of === 'corrections' ? 'none' : 'bad' };
    return { of, words: words(value), light: is_old(group) ? 'bad' : light_of(value, limits) };
  };
  return [
    one('position', position, position.horizontal_accuracy_m, POSITION_M, accuracy),
    one(
      'heading',
      position,
      position.heading_accuracy_deg,
      HEADING_DEG,
      (deg) => `±${degrees_text(deg)}`,
    ),
    one('corrections', gnss, gnss.correction_age_s, CORRECTIONS_S, age),
  ];
};
