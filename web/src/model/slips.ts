// Where the robot slipped, and the words for it.

import type { Answer } from './answer';
import type { LatLon } from './plan';
import { say } from './say';

export type SlipKind = 'slip' | 'side' | 'dug';
export interface Slip extends LatLon {
  readonly id: number;
  readonly time: string;
  readonly kind: SlipKind;
  readonly percent: number;
  readonly times: number;
}

export interface SlipCalls {
  /** Newest first. */
  all(): Promise<Answer<readonly Slip[]>>;
  clear(): Promise<Answer<unknown>>;
}

/** What happened at a place: "slipped by 40 %, 3 times". */
export const slip_words = ({ kind, percent, times }: Slip): string => {
  const figure = `${percent.toFixed(0)} %`;
  const what =
    kind === 'dug'
      ? say('the_wheels_turned_and_it_stood')
      : kind === 'slip'
        ? say('slipped_by_figure', { figure })
        : say('slid_aside_by_figure', { figure });
  return times === 1 ? what : say('what_times_times', { what, times });
};
