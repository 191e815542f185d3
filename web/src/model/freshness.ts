// How old is what we show? Two ages add up: the age of the measurement when the server sent it, and
// the time since the message came. Time is an argument everywhere: milliseconds of any clock that
// never goes back.

import type { Measured } from './vehicle';

/** A healthy stream brings 10 messages a second; after this silence the page greys out. */
export const SILENT_AFTER_MS = 1500;
/** An open socket that stays silent for this long is closed and opened again. */
export const REOPEN_AFTER_MS = 4000;

export type SocketState = 'connecting' | 'open' | 'closed';

export interface LinkHealth {
  readonly socket: SocketState;
  /** When the last message came; null: never. */
  readonly last_message_ms: number | null;
}

export const link_age_s = (link: LinkHealth, now_ms: number): number | null =>
  link.last_message_ms === null ? null : Math.max(0, now_ms - link.last_message_ms) / 1000;

/** True when what is shown may be old: commands that move the robot are refused by the page. */
export const link_stale = (link: LinkHealth, now_ms: number): boolean =>
  link.socket !== 'open' ||
  link.last_message_ms === null ||
  now_ms - link.last_message_ms > SILENT_AFTER_MS;

export const should_reopen = (opened_ms: number, link: LinkHealth, now_ms: number): boolean =>
  now_ms - Math.max(opened_ms, link.last_message_ms ?? opened_ms) > REOPEN_AFTER_MS;

/** Full age of a measured group now, seconds; null while it was never measured. */
export const age_now_s = (group: Measured, link: LinkHealth, now_ms: number): number | null => {
  const since = link_age_s(link, now_ms);
  return group.age_s === null || since === null ? null : group.age_s + since;
};

export const group_stale = (group: Measured, link: LinkHealth, now_ms: number): boolean =>
  group.stale || link_stale(link, now_ms);

/**
 * Wait before the next attempt to connect: doubles from 0.25 s to 5 s, and is spread so that many
 * pages do not come back in the same instant. @param attempt from 0 @param random in [0, 1)
 */
export const backoff_ms = (attempt: number, random: number): number =>
  Math.min(250 * 2 ** Math.min(attempt, 10), 5000) * (0.7 + 0.3 * random);
