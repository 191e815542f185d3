import { describe, expect, test } from 'vitest';

import { slip_words, type Slip } from '../src/model/slips';

const slip = (change: Partial<Slip>): Slip => ({
  id: 1,
  lat: 58,
  lon: 26,
  time: '2026-05-01T10:00:00Z',
  kind: 'slip',
  percent: 39.6,
  times: 1,
  ...change,
});

describe('slips', () => {
  test('say what happened and how often', () => {
    expect(slip_words(slip({}))).toBe('slipped by 40 %');
    expect(slip_words(slip({ kind: 'side', percent: 12.5, times: 2 }))).toBe(
      'slid aside by 13 %, 2 times',
    );
    expect(slip_words(slip({ kind: 'dug', percent: 100 }))).toBe('the wheels turned and it stood');
  });
});
