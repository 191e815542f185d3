// Where the robot slipped, and the words for it.

import type { Answer } from './answer';
import type { LatLon } from './plan';

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
      ? 'the wheels turned and it stood'
      : kind === 'slip'
        ? `slipped by ${figure}`
        : `slid aside by ${figure}`;
  return times === 1 ? what : `${what}, ${times} times`;
};
