// The instruments that a driver may choose, and what they show: figures for the drawings, null where
// something is not known.

import { say, told } from './say';
import type { Vehicle } from './vehicle';

export const INSTRUMENTS = ['compass', 'attitude', 'deviation', 'battery', 'link', 'rc'] as const;
export type Instrument = (typeof INSTRUMENTS)[number];
export const instrument_words: Readonly<Record<Instrument, string>> = told({
  compass: 'compass',
  attitude: 'attitude',
  deviation: 'deviation',
  battery: 'battery',
  link: 'link',
  rc: 'radio',
});

/** What was kept on the device; an unknown word is none. */
export const instruments_of = (kept: unknown, otherwise: readonly Instrument[]): Instrument[] =>
  Array.isArray(kept) ? INSTRUMENTS.filter((each) => kept.includes(each)) : [...otherwise];

/** In the order of INSTRUMENTS. */
export const with_instrument = (
  chosen: readonly Instrument[],
  which: Instrument,
  on: boolean,
): Instrument[] => INSTRUMENTS.filter((each) => (each === which ? on : chosen.includes(each)));

export interface Compass {
  readonly heading_deg: number | null;
  /** The way that it goes over ground; null: it stands, or nothing tells. */
  readonly course_deg: number | null;
  /** To the item in hand, or to where it drives. */
  readonly bearing_deg: number | null;
}
/** Slower than this the course is noise. */
const GOES_MPS = 0.1;
const turn = (deg: number): number => ((deg % 360) + 360) % 360;

export const compass_of = ({ position, estimator, mission }: Vehicle): Compass => {
  const { heading_deg, speed_mps } = position;
  const goes = speed_mps !== null && Math.abs(speed_mps) >= GOES_MPS;
  // Metres to its left for each metre ahead: it goes that much to the left of where it points.
  const crab_deg = (Math.atan(estimator.side_slip ?? 0) * 180) / Math.PI;
  const course = heading_deg !== null && goes;
  return {
    heading_deg,
    course_deg: course ? turn(heading_deg - crab_deg + (speed_mps < 0 ? 180 : 0)) : null,
    bearing_deg: mission.bearing_to_item_deg,
  };
};

/** How far the needle of the deviation stands from its middle: -1 (left end) to 1, at the limit where
 * the mission pauses, or at one metre. Null: no way is driven. */
export const needle_of = ({ mission }: Vehicle): { at: number; end_m: number } | null => {
  const { cross_track_m, cross_track_limit_m } = mission;
  if (cross_track_m === null) return null;
  // Fine near the way: a tenth of a metre must be seen where three are allowed.
  const end_m = Math.min(cross_track_limit_m ?? 1, 1);
  return { at: Math.max(-1, Math.min(1, 0 - cross_track_m / end_m)), end_m };
};

export type Light = 'good' | 'warn' | 'bad' | 'none';

export interface RadioView {
  readonly word: string;
  readonly light: Light;
}
export const radio_view = ({ rc, control }: Vehicle): RadioView => {
  if (rc.age_s === null) return { word: say('not_heard'), light: 'none' };
  if (rc.lost === true || rc.stale) return { word: say('lost'), light: 'bad' };
  return control === 'rc'
    ? { word: say('it_drives'), light: 'warn' }
    : { word: say('heard'), light: 'good' };
};

/** Of a battery: empty below a fifth, low below a third. */
export const battery_light = ({ charge_pct, fault }: Vehicle['battery']): Light =>
  fault === true
    ? 'bad'
    : charge_pct === null
      ? 'none'
      : charge_pct < 20
        ? 'bad'
        : charge_pct < 33
          ? 'warn'
          : 'good';
