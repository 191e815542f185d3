// How old is what we show? Three ages add up: the age of the measurement when the robot sent it, its
// way to us, and the time since. Time is an argument everywhere: milliseconds of any clock that
// never goes back.

import { say } from './say';
import type { Measured } from './vehicle';

/** Data older than this is grey, and nothing that moves the robot is offered on it. Grey is seen within
 * a second of the loss: what was lost last was a tenth old, and to be drawn takes a moment. */
export const OLD_AFTER_MS = 850;
/** Slower than this there and back, and the link is no longer good. A click lives for 1 s. */
const SLOW_ROUND_TRIP_S = 0.5;
/** Our words do not reach the robot, or its answers not us. */
const UNHEARD_AFTER_MS = 2000;
/** An open socket that stays silent for this long is closed and opened again. */
export const REOPEN_AFTER_MS = 4000;
/** Silent, or not open yet, for so long: it is asked whether the robot can be reached otherwise. */
export const PROBE_AFTER_MS = 1000;
/** A probe that was answered within this time is no slow link. */
export const PROBE_LIMIT_MS = 800;
/** So is one on which nothing that we send comes back, or that does not open: slow is not dead. */
export const GIVE_UP_AFTER_MS = 15_000;

export type SocketState = 'connecting' | 'open' | 'closed';

export interface LinkHealth {
  readonly socket: SocketState;
  /** When the last message of any kind came; null: never. */
  readonly last_message_ms: number | null;
  /** When the shown state of the robot was true; null: none came, or no round trip tells yet. */
  readonly true_at_ms: number | null;
  /** Of the last ping that was answered. */
  readonly round_trip_s: number | null;
  /** When the oldest ping without an answer was sent. */
  readonly unanswered_since_ms: number | null;
}

export const NO_LINK: LinkHealth = {
  socket: 'connecting',
  last_message_ms: null,
  true_at_ms: null,
  round_trip_s: null,
  unanswered_since_ms: null,
};

/** Age of the data; null: not known. */
export const link_age_s = (link: LinkHealth, now_ms: number): number | null =>
  link.true_at_ms === null ? null : Math.max(0, now_ms - link.true_at_ms) / 1000;

/** There and back as it is now: an answer that is overdue counts already. */
export const round_trip_s = (link: LinkHealth, now_ms: number): number | null => {
  const waits_ms = link.unanswered_since_ms === null ? 0 : now_ms - link.unanswered_since_ms;
  return link.round_trip_s === null && waits_ms < UNHEARD_AFTER_MS
    ? null
    : Math.max(link.round_trip_s ?? 0, waits_ms / 1000);
};

/** True when what is shown is old, or of unknown age: nothing that moves the robot is offered. */
export const link_stale = (link: LinkHealth, now_ms: number): boolean =>
  link.socket !== 'open' || link.true_at_ms === null || now_ms - link.true_at_ms > OLD_AFTER_MS;

export interface LinkView {
  readonly word: string;
  readonly tone: 'good' | 'warn' | 'bad';
}

const bad = (word: string): LinkView => ({ word, tone: 'bad' });

/** One word for the link, and its colour. Green only where data is fresh both ways. */
export const link_view = (link: LinkHealth, now_ms: number): LinkView => {
  const { last_message_ms, true_at_ms } = link;
  if (link.socket !== 'open')
    return bad(last_message_ms === null ? say('connecting') : say('offline'));
  if (last_message_ms === null || now_ms - last_message_ms > OLD_AFTER_MS)
    return bad(say('silent'));
  const waits_ms = link.unanswered_since_ms === null ? 0 : now_ms - link.unanswered_since_ms;
  const unheard = waits_ms > UNHEARD_AFTER_MS;
  if (true_at_ms === null) {
    return unheard ? bad(say('unheard')) : { word: say('measuring'), tone: 'warn' };
  }
  const back_s = round_trip_s(link, now_ms) ?? 0;
  if (now_ms - true_at_ms > OLD_AFTER_MS) return bad(say('late'));
  if (unheard) return bad(say('unheard'));
  return back_s > SLOW_ROUND_TRIP_S || now_ms - true_at_ms > 1000 * SLOW_ROUND_TRIP_S
    ? { word: say('slow'), tone: 'warn' }
    : { word: say('live'), tone: 'good' };
};

/** Whether a socket is worth no more than a closed one. */
export const should_reopen = (opened_ms: number, link: LinkHealth, now_ms: number): boolean => {
  if (link.socket !== 'open') return now_ms - opened_ms > GIVE_UP_AFTER_MS;
  const heard_ms = Math.max(opened_ms, link.last_message_ms ?? opened_ms);
  const unanswered_ms = now_ms - (link.unanswered_since_ms ?? now_ms);
  return now_ms - heard_ms > REOPEN_AFTER_MS || unanswered_ms > GIVE_UP_AFTER_MS;
};

/** A link that comes back may leave a socket behind that is tried anew only after many seconds: the
 * longer nothing got through, the rarer it is. So it is asked beside it. */
export const should_probe = (opened_ms: number, link: LinkHealth, now_ms: number): boolean => {
  const heard_ms = link.socket === 'open' ? (link.last_message_ms ?? 0) : 0;
  return link.socket !== 'closed' && now_ms - Math.max(opened_ms, heard_ms) > PROBE_AFTER_MS;
};

/** Full age of a measured group now, seconds; null while it was never measured. */
export const age_now_s = (group: Measured, link: LinkHealth, now_ms: number): number | null => {
  const since = link_age_s(link, now_ms);
  return group.age_s === null || since === null ? null : group.age_s + since;
};

export const group_stale = (group: Measured, link: LinkHealth, now_ms: number): boolean =>
  group.stale || link_stale(link, now_ms);

/**
 * Wait before the next attempt to connect: doubles from 0.25 s to 0.7 s, so that a link that is back is
 * used within a second, and is spread so that many pages do not come back in the same instant. @param attempt from 0 @param random in [0, 1)
 */
export const backoff_ms = (attempt: number, random: number): number =>
  Math.min(250 * 2 ** Math.min(attempt, 10), 700) * (0.7 + 0.3 * random);
