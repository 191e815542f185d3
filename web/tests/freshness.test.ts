import { describe, expect, test } from 'vitest';

import {
  age_now_s,
  backoff_ms,
  GIVE_UP_AFTER_MS,
  group_stale,
  link_age_s,
  link_stale,
  link_view,
  NO_LINK,
  OLD_AFTER_MS,
  REOPEN_AFTER_MS,
  PROBE_AFTER_MS,
  PROBE_LIMIT_MS,
  round_trip_s,
  should_probe,
  should_reopen,
  type LinkHealth,
} from '../src/model/freshness';

const open: LinkHealth = {
  socket: 'open',
  last_message_ms: 10_000,
  true_at_ms: 9_990,
  round_trip_s: 0.02,
  unanswered_since_ms: null,
};
/** Two seconds each way: messages come as often as ever, and all are old. */
const slow: LinkHealth = {
  ...open,
  true_at_ms: 8_000,
  round_trip_s: 4,
  unanswered_since_ms: 9_900,
};

describe('freshness', () => {
  test('a link is stale when it is closed, silent, of unknown age, or never said a word', () => {
    expect(link_stale(open, 9_990 + OLD_AFTER_MS)).toBe(false);
    expect(link_stale(open, 9_991 + OLD_AFTER_MS)).toBe(true);
    expect(link_stale({ ...open, socket: 'closed' }, 10_000)).toBe(true);
    expect(link_stale({ ...open, true_at_ms: null }, 10_000)).toBe(true);
    expect(link_stale(NO_LINK, 10_000)).toBe(true);
    // A tenth old when the link goes, and drawn a moment later: grey within a second.
    expect(OLD_AFTER_MS + 100).toBeLessThan(1000);
  });

  test('the age of a value is its age when it was sent, its way, and the silence since', () => {
    const group = { age_s: 0.4, stale: false };
    expect(age_now_s(group, open, 12_000)).toBeCloseTo(2.41);
    expect(age_now_s(group, slow, 10_000)).toBeCloseTo(2.4);
    expect(age_now_s({ age_s: null, stale: true }, open, 12_000)).toBeNull();
    expect(link_age_s(NO_LINK, 5)).toBeNull();
    expect(link_age_s(open, 9_000)).toBe(0);
  });

  test('a value is stale when the server says so or the link is', () => {
    expect(group_stale({ age_s: 0, stale: false }, open, 10_100)).toBe(false);
    expect(group_stale({ age_s: 9, stale: true }, open, 10_100)).toBe(true);
    expect(group_stale({ age_s: 0, stale: false }, open, 20_000)).toBe(true);
    expect(group_stale({ age_s: 0, stale: false }, slow, 10_000)).toBe(true);
  });

  test('messages that were long on their way are late, never live, however often they come', () => {
    expect(link_view(open, 10_050)).toEqual({ word: 'Live', tone: 'good' });
    expect(link_view(slow, 10_050)).toEqual({ word: 'Late', tone: 'bad' });
    expect(link_age_s(slow, 10_000)).toBe(2);
    expect(round_trip_s(slow, 10_000)).toBe(4);
  });

  test('half a second is slow: no longer green, not yet grey', () => {
    const half = { ...open, true_at_ms: 9_500, round_trip_s: 1 };
    expect(link_view(half, 10_000)).toEqual({ word: 'Slow', tone: 'warn' });
    expect(link_stale(half, 10_000)).toBe(false);
  });

  test('a link on which only the way to us works is told as such, and grows', () => {
    const deaf = { ...open, unanswered_since_ms: 7_900 };
    expect(link_view(deaf, 10_000)).toEqual({ word: 'Unheard', tone: 'bad' });
    expect(round_trip_s(deaf, 10_000)).toBeCloseTo(2.1);
    expect(link_view({ ...deaf, unanswered_since_ms: 9_000 }, 10_000).tone).not.toBe('good');
    // Also where nothing tells how old the data is: nobody measures any more.
    expect(link_view({ ...deaf, true_at_ms: null }, 10_000).word).toBe('Unheard');
  });

  test('before a round trip the age is not known, and that is not live', () => {
    const fresh = { ...open, true_at_ms: null, round_trip_s: null };
    expect(link_view(fresh, 10_000)).toEqual({ word: 'Measuring', tone: 'warn' });
    expect(round_trip_s(fresh, 10_000)).toBeNull();
    expect(link_view(NO_LINK, 0).word).toBe('Connecting');
    expect(link_view({ ...open, socket: 'closed' }, 10_000).word).toBe('Offline');
    expect(link_view(open, 11_001).word).toBe('Silent');
  });

  test('an open but silent socket is given up after a while, a slow one is not', () => {
    expect(should_reopen(0, open, 10_000 + REOPEN_AFTER_MS)).toBe(false);
    expect(should_reopen(0, open, 10_001 + REOPEN_AFTER_MS)).toBe(true);
    expect(should_reopen(19_000, open, 20_000)).toBe(false);
    expect(should_reopen(0, slow, 10_000)).toBe(false);
    // Connecting over two seconds each way takes eight.
    expect(should_reopen(0, NO_LINK, 8000)).toBe(false);
    expect(should_reopen(0, NO_LINK, GIVE_UP_AFTER_MS + 1)).toBe(true);
    const deaf = { ...open, unanswered_since_ms: 10_000 - GIVE_UP_AFTER_MS - 1 };
    expect(should_reopen(0, deaf, 10_000)).toBe(true);
  });

  test('a socket that says nothing for a second is doubted, one that is closed or speaks is not', () => {
    expect(should_probe(0, open, 10_000 + PROBE_AFTER_MS)).toBe(false);
    expect(should_probe(0, open, 10_001 + PROBE_AFTER_MS)).toBe(true);
    expect(should_probe(0, slow, 10_000)).toBe(false);
    expect(should_probe(19_500, open, 20_000)).toBe(false);
    // Connecting: what came over the one before says nothing.
    expect(should_probe(9_000, { ...open, socket: 'connecting' }, 10_001)).toBe(true);
    expect(should_probe(0, { ...open, socket: 'closed' }, 20_000)).toBe(false);
    expect(PROBE_AFTER_MS + PROBE_LIMIT_MS).toBeLessThan(REOPEN_AFTER_MS);
  });

  test('waits double up to seven tenths of a second and are spread', () => {
    expect(backoff_ms(0, 1)).toBe(250);
    expect(backoff_ms(1, 1)).toBe(500);
    expect(backoff_ms(99, 1)).toBe(700);
    expect(backoff_ms(0, 0)).toBeLessThan(backoff_ms(0, 0.9));
  });
});
