// Cameras: how old a picture is, what is said of it, and how large the next one is wished. Time is an
// argument: milliseconds of a clock that never goes back.

import type { Answer } from './answer';
import { fixed } from './figures';
import { say } from './say';

export interface Camera {
  readonly name: string;
  readonly state: string;
  readonly reason: string | null;
}

/** What an asking for the newest picture brought. */
export interface Glimpse {
  /** A JPEG; null: there is none other than the one that is shown. */
  readonly picture: ArrayBuffer | null;
  readonly count: number;
  /** When the robot answered. */
  readonly age_ms: number;
}

export interface CameraCalls {
  list(): Promise<Answer<readonly Camera[]>>;
  /** @param after count of the picture that is shown; null: none is */
  look(
    name: string,
    after: number | null,
    divisor: Divisor,
    signal: AbortSignal,
  ): Promise<Glimpse | null>;
}

export type Divisor = 1 | 2 | 4 | 8;

/** A picture older than this shows what was: it is grey, and says so. */
export const FROZEN_AFTER_MS = 1000;
/** So long is waited for a picture, and then asked again. */
export const PATIENCE_MS = 5000;
/** Between two askings, where there was nothing new; after one that failed. */
export const AGAIN_MS = 70;
export const FAILED_MS = 700;

/**
 * When what a glimpse shows was taken: it was that old when the robot answered, which was after it
 * was asked. The way there counts as age, too: never younger than it is.
 */
export const taken_ms = (asked_ms: number, glimpse: Glimpse): number =>
  asked_ms - Math.max(0, glimpse.age_ms);

export const is_frozen = (taken: number | null, now_ms: number): boolean =>
  taken === null || now_ms - taken > FROZEN_AFTER_MS;

const seconds_text = (ms: number): string =>
  ms < 99_950 ? `${fixed(ms / 1000, 1)} s` : `${Math.round(ms / 1000)} s`;

/** What stands on the picture: "0.2 s", "Frozen 3.2 s". @param taken null: none came yet */
export const age_words = (taken: number | null, now_ms: number): string => {
  if (taken === null) return say('no_picture_yet');
  const age_ms = Math.max(0, now_ms - taken);
  return age_ms > FROZEN_AFTER_MS
    ? say('frozen_age_ms', { age_ms: seconds_text(age_ms) })
    : seconds_text(age_ms);
};

/** How well the link carries pictures of this size. */
export interface Pace {
  readonly divisor: Divisor;
  /** Pictures in a row that came quickly. */
  readonly quick: number;
}

export const FIRST_PACE: Pace = { divisor: 1, quick: 0 };
const SLOW_MS = 500;
const QUICK_MS = 150;
/** So many quick ones, and a larger one is tried: seldom, for where it fails a picture is late. */
const QUICK_ONES = 40;
const SMALLER: Readonly<Record<Divisor, Divisor>> = { 1: 2, 2: 4, 4: 8, 8: 8 };
const LARGER: Readonly<Record<Divisor, Divisor>> = { 1: 1, 2: 1, 4: 2, 8: 4 };

/** @param took_ms from the asking to the whole picture */
export const next_pace = ({ divisor, quick }: Pace, took_ms: number): Pace => {
  if (took_ms > SLOW_MS) return { divisor: SMALLER[divisor], quick: 0 };
  if (took_ms > QUICK_MS) return { divisor, quick: 0 };
  return quick + 1 < QUICK_ONES
    ? { divisor, quick: quick + 1 }
    : { divisor: LARGER[divisor], quick: 0 };
};

/** What a device keeps of it. */
export interface CameraChoice {
  readonly on: boolean;
  readonly name: string | null;
}

export const choice_of = (text: string | null): CameraChoice => {
  try {
    const kept: unknown = JSON.parse(text ?? 'null');
    const { on, name } = { ...(kept as Partial<Record<'on' | 'name', unknown>> | null) };
    return { on: on !== false, name: typeof name === 'string' ? name : null };
  } catch {
    return { on: true, name: null };
  }
};

/** The chosen one, or the first where it is not there (any more); null: there is none. */
export const chosen = (cameras: readonly Camera[], name: string | null): Camera | null =>
  cameras.find((camera) => camera.name === name) ?? cameras[0] ?? null;
