// The colour of the trail: how far off its way the robot was there, or how fast. Few classes, that are
// told apart by brightness and by the width of the line, too: not everybody sees colours, and in the sun
// nobody does.

import { shortest } from './figures';
import { say } from './say';
import { shown_per, type SpeedUnit, type TrailBy } from './settings';
import type { Driven } from './trail';

/** Colours, from little to much. */
export const CLASSES = 5;
/** Where it is not known. */
export const PLAIN_CLASS = CLASSES;

/** What RTK keeps, a good one, a hand, two. */
const OFF_LIMITS_M: readonly number[] = [0.02, 0.05, 0.1, 0.2];
/** Of the vehicle's greatest speed: the same from mission to mission. */
const SPEED_SHARES: readonly number[] = [0.2, 0.4, 0.6, 0.8];
const TOP_MPS = 1.5;

export interface TrailShades {
  readonly by: 'deviation' | 'speed';
  /** Upper ends of all classes but the last, metres or m/s. */
  readonly limits: readonly number[];
}

/** @param top_mps the vehicle's greatest speed; null: not known @return null: in one colour */
export const trail_shades = (by: TrailBy, top_mps: number | null): TrailShades | null => {
  if (by === 'plain') return null;
  if (by === 'deviation') return { by, limits: OFF_LIMITS_M };
  const top = top_mps !== null && top_mps > 0 ? top_mps : TOP_MPS;
  return { by, limits: SPEED_SHARES.map((share) => Math.round(100 * share * top) / 100) };
};

/** From 0; PLAIN_CLASS: not known. */
export const class_of = ({ by, limits }: TrailShades, { speed_mps, off_m }: Driven): number => {
  const value = Math.abs(by === 'speed' ? speed_mps : off_m);
  if (Number.isNaN(value)) return PLAIN_CLASS;
  let k = 0;
  while (k < limits.length && value > (limits[k] ?? 0)) k += 1;
  return k;
};

export interface TrailLegend {
  /** "Off path, cm". */
  readonly title: string;
  /** "≤ 2" … "> 20", in the order of the classes. */
  readonly words: readonly string[];
}

export const trail_legend = ({ by, limits }: TrailShades, speed: SpeedUnit): TrailLegend => {
  const off = by === 'deviation';
  const per = off ? 100 : shown_per('m/s', speed);
  const texts = limits.map((limit) => shortest(limit * per, per > 1 ? 1 : 2));
  return {
    title: `${say(off ? 'off_path' : 'speed')}, ${off ? 'cm' : speed}`,
    words: [...texts.map((text) => `≤ ${text}`), `> ${texts[texts.length - 1] ?? ''}`],
  };
};
