import { expect, test } from 'vitest';

import { beginning_words, smoothed_words, tolerance_words } from '../src/model/start';
import type { Preview, Vehicle } from '../src/model/vehicle';

const preview = (joins_after_m: number | null, left_out: number): Preview =>
  ({ joins_after_m, left_out }) as Preview;

test('a start says where it joins its way, and what it leaves out', () => {
  expect(beginning_words(preview(null, 0))).toBe('');
  expect(beginning_words(preview(0, 0))).toBe(
    'The robot stands at the beginning of its way and goes on from there.',
  );
  expect(beginning_words(preview(2.4, 1))).toBe(
    'The robot joins its way where it stands, 2.40 m after its beginning. 1 item before it is left out; choose an item to begin there.',
  );
});

test('how far a smooth way is from its points is said, the farthest of several', () => {
  expect(smoothed_words([])).toBe('');
  const one = { first_item: 2, last_item: 41, deviation_m: 0.13 };
  expect(smoothed_words([one])).toBe(
    'Items 2 to 41 are driven as a smooth way, at most 0.13 m beside them.',
  );
  expect(smoothed_words([one, { ...one, deviation_m: 0.1 }])).toBe(
    '2 stretches of dense points are driven as a smooth way, at most 0.13 m beside them.',
  );
});

test('how near is near enough is said while a mission drives', () => {
  const mission = (arrival_radius_m: number | null): Vehicle['mission'] =>
    ({ arrival_radius_m, cross_track_limit_m: 3 }) as Vehicle['mission'];
  expect(tolerance_words(mission(null))).toBe('');
  expect(tolerance_words(mission(3.6))).toBe(
    'Counts as reached within 3.60 m; pauses 3.00 m off its way.',
  );
});
