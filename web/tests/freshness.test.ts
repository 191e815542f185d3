import { describe, expect, test } from 'vitest';

import {
  age_now_s,
  backoff_ms,
  group_stale,
  link_age_s,
  link_stale,
  REOPEN_AFTER_MS,
  should_reopen,
  SILENT_AFTER_MS,
  type LinkHealth,
} from '../src/model/freshness';

const open: LinkHealth = { socket: 'open', last_message_ms: 10_000 };

describe('freshness', () => {
  test('a link is stale when it is closed, silent, or never said a word', () => {
    expect(link_stale(open, 10_000 + SILENT_AFTER_MS)).toBe(false);
    expect(link_stale(open, 10_001 + SILENT_AFTER_MS)).toBe(true);
    expect(link_stale({ ...open, socket: 'closed' }, 10_000)).toBe(true);
    expect(link_stale({ socket: 'open', last_message_ms: null }, 10_000)).toBe(true);
  });

  test('the age of a value is its age on arrival and the silence since', () => {
    const group = { age_s: 0.4, stale: false };
    expect(age_now_s(group, open, 12_000)).toBeCloseTo(2.4);
    expect(age_now_s({ age_s: null, stale: true }, open, 12_000)).toBeNull();
    expect(link_age_s({ socket: 'connecting', last_message_ms: null }, 5)).toBeNull();
    expect(link_age_s(open, 9_000)).toBe(0);
  });

  test('a value is stale when the server says so or the link is', () => {
    expect(group_stale({ age_s: 0, stale: false }, open, 10_100)).toBe(false);
    expect(group_stale({ age_s: 9, stale: true }, open, 10_100)).toBe(true);
    expect(group_stale({ age_s: 0, stale: false }, open, 20_000)).toBe(true);
  });

  test('an open but silent socket is given up after a while, a fresh one gets its time', () => {
    expect(should_reopen(0, open, 10_000 + REOPEN_AFTER_MS)).toBe(false);
    expect(should_reopen(0, open, 10_001 + REOPEN_AFTER_MS)).toBe(true);
    expect(should_reopen(19_000, open, 20_000)).toBe(false);
    expect(should_reopen(0, { socket: 'connecting', last_message_ms: null }, 5000)).toBe(true);
  });

  test('waits double up to five seconds and are spread', () => {
    expect(backoff_ms(0, 1)).toBe(250);
    expect(backoff_ms(3, 1)).toBe(2000);
    expect(backoff_ms(99, 1)).toBe(5000);
    expect(backoff_ms(0, 0)).toBeLessThan(backoff_ms(0, 0.9));
  });
});
