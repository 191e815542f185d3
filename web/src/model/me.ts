// Where the person is, as the phone in the hand tells: how good that is, and what the robot is told of it
// when it shall come. Time is an argument: milliseconds of the page's clock that never goes back.
//
//   robot ──────▶ ○ told          ● phone      The robot is told a place on the circle within which the
//                 └─ accuracy_m ──┘            phone may be, on its own side: it keeps its distance to all
//                                              places where the person may stand.

import type { Answer } from './answer';
import { fixed } from './figures';
import { distance_m, offset_between, offset_from } from './geo';
import type { LatLon } from './plan';
import { say } from './say';

export interface Fix extends LatLon {
  /** 95 of 100 times the phone is within it. */
  readonly accuracy_m: number;
  readonly at_ms: number;
}

/** Why a phone tells no place. */
export type NoPlace = 'insecure' | 'missing' | 'denied' | 'unavailable';

export interface MyTarget extends LatLon {
  readonly speed_mps: number;
  readonly heading_deg: number;
}

export interface MeCalls {
  /** Null: it can be asked. */
  readonly impossible: NoPlace | null;
  /** @return ends it */
  watch(on_fix: (fix: Fix) => void, on_none: (why: NoPlace) => void): () => void;
  /** Of FOLLOW: where the target is. */
  tell(target: MyTarget): Promise<Answer<unknown>>;
  /** How far it stays from a target that stands; null: not known. */
  gap_m(): Promise<number | null>;
  /** The page was put away: a phone in a pocket tells nothing. @return ends it */
  on_hidden(hidden: () => void): () => void;
  now_ms(): number;
}

/** Worse than that, "here" is a circle in which one had to look for the robot. */
export const MOST_ACCURACY_M = 10;
/** Older, and the person may be elsewhere: four metres at a walk. */
export const OLDEST_S = 3;
/** Phones find their place once a second; the robot brakes after a second without a word. */
export const TELL_EVERY_MS = 500;
const TELL_UP_TO_S = 1.6;
/** The told place goes no faster than this because the phone becomes surer or less sure: it would be
 * taken for a jump. */
const SURER_M = 1;
const WALK_S = 2.5;
const WALKS_MPS = 0.4;
const FASTEST_MPS = 3;
const FORETOLD_S = 1;

/** A phone does not know centimetres. */
export const about_m = (m: number): string => `${fixed(m, m < 9.95 ? 1 : 0)} m`;

/** The last fixes, the newest last. */
export type Me = readonly Fix[];

export const newest = (me: Me): Fix | null => me.at(-1) ?? null;

/** With one more; what is out of order, or no place, changes nothing. */
export const with_fix = (me: Me, fix: Fix): Me => {
  const before = newest(me);
  const usable = [fix.lat, fix.lon, fix.accuracy_m, fix.at_ms].every(Number.isFinite);
  if (!usable || fix.accuracy_m < 0 || (before && fix.at_ms <= before.at_ms)) return me;
  return [...me.filter(({ at_ms }) => fix.at_ms - at_ms <= WALK_S * 1000), fix];
};

export const age_s = (me: Me, now_ms: number): number | null => {
  const last = newest(me);
  return last ? Math.max(0, now_ms - last.at_ms) / 1000 : null;
};

/** Metres a second, east and north: by the places of the last seconds. Standing, a place wanders too. */
const walk_of = (me: Me): { readonly east_mps: number; readonly north_mps: number } => {
  const [first, last] = [me[0], newest(me)];
  const still = { east_mps: 0, north_mps: 0 };
  const passed_s = first && last ? (last.at_ms - first.at_ms) / 1000 : 0;
  if (!first || !last || passed_s < 0.8) return still;
  const { east_m, north_m } = offset_between(first, last);
  const speed_mps = Math.hypot(east_m, north_m) / passed_s;
  if (speed_mps < WALKS_MPS) return still;
  const share = Math.min(1, FASTEST_MPS / speed_mps) / passed_s;
  return { east_mps: east_m * share, north_mps: north_m * share };
};

const none_words = (why: NoPlace): string => {
  switch (why) {
    case 'insecure':
      return say('me_insecure');
    case 'missing':
      return say('me_missing');
    case 'denied':
      return say('me_denied');
    case 'unavailable':
      return say('me_unavailable');
  }
};

/** Why nobody should go by it now; null: it is good. */
export const why_not_here = (me: Me, now_ms: number, none: NoPlace | null): string | null => {
  const last = newest(me);
  const old_s = age_s(me, now_ms) ?? 0;
  // One try that failed does not undo the place of a second ago.
  const counts = none !== 'unavailable' || !last || old_s > OLDEST_S;
  if (none !== null && counts) return none_words(none);
  if (!last) return say('me_waiting');
  if (old_s > OLDEST_S) return say('me_old', { age: old_s.toFixed(0) });
  if (last.accuracy_m > MOST_ACCURACY_M) {
    return say('me_vague', { accuracy: about_m(last.accuracy_m), most: about_m(MOST_ACCURACY_M) });
  }
  return null;
};

/** What the map shows of it. */
export interface MeOnMap extends LatLon {
  readonly accuracy_m: number;
  readonly old: boolean;
}

export const me_on_map = (me: Me, now_ms: number): MeOnMap | null => {
  const last = newest(me);
  if (!last) return null;
  const { lat, lon, accuracy_m } = last;
  return { lat, lon, accuracy_m, old: (age_s(me, now_ms) ?? 0) > OLDEST_S };
};

/** How far before the phone's place the next told one is. @param before that of the last; null: none */
export const kept_m = (me: Me, before_m: number | null): number => {
  const wanted_m = newest(me)?.accuracy_m ?? 0;
  if (before_m === null) return wanted_m;
  return Math.max(before_m - SURER_M, Math.min(before_m + SURER_M, wanted_m));
};

/** What the robot is told; null: nothing is known of the one or the other, or not of late.
 * @param before_m so far before the phone's place it is */
export const my_target = (
  me: Me,
  robot: LatLon | null,
  now_ms: number,
  before_m: number = kept_m(me, null),
): MyTarget | null => {
  const last = newest(me);
  if (!last || !robot || (age_s(me, now_ms) ?? 0) > TELL_UP_TO_S) return null;
  const { east_mps, north_mps } = walk_of(me);
  const ahead_s = Math.min(FORETOLD_S, age_s(me, now_ms) ?? 0);
  const here = offset_from(last, { east_m: east_mps * ahead_s, north_m: north_mps * ahead_s });
  const away_m = distance_m(here, robot);
  const part = away_m > 0 ? Math.min(1, before_m / away_m) : 0;
  const to_robot = offset_between(here, robot);
  const told = offset_from(here, {
    east_m: to_robot.east_m * part,
    north_m: to_robot.north_m * part,
  });
  const heading_deg = (Math.atan2(east_mps, north_mps) * 180) / Math.PI;
  return {
    ...told,
    speed_mps: Math.hypot(east_mps, north_mps),
    heading_deg: (heading_deg + 360) % 360,
  };
};
