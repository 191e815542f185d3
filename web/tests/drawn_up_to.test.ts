import { expect, test } from 'vitest';

import { DrawnUpTo } from '../src/model/drawn_up_to';

test('a route whose items come fast is drawn anew every ten seconds', () => {
  const drawn = new DrawnUpTo();
  drawn.begin(3);
  drawn.keep(1000);
  expect(drawn.is_behind(3, 60_000)).toBe(false);
  expect(drawn.is_behind(4, 3000)).toBe(false);
  expect(drawn.is_behind(5, 10_999)).toBe(false);
  expect(drawn.is_behind(5, 11_000)).toBe(true);
});

test('a long leg that ends is shown at once', () => {
  const drawn = new DrawnUpTo();
  drawn.begin(3);
  drawn.keep(1000);
  expect(drawn.is_behind(4, 45_000)).toBe(true);
});

test('begin, end and a way back are shown at once', () => {
  const drawn = new DrawnUpTo();
  expect(drawn.is_behind(1, 0)).toBe(true);
  drawn.begin(0);
  drawn.keep(1000);
  expect(drawn.is_behind(1, 1001)).toBe(true);
  drawn.begin(7);
  drawn.keep(1000);
  expect(drawn.is_behind(0, 1001)).toBe(true);
  expect(drawn.is_behind(1, 1001)).toBe(true);
});

test('what is drawn in pieces counts from when all of them are seen', () => {
  const drawn = new DrawnUpTo();
  drawn.begin(3);
  drawn.keep(1000);
  drawn.begin(4);
  expect(drawn.begun).toBe(4);
  expect(drawn.item).toBe(3);
  expect(drawn.is_behind(4, 12_000)).toBe(true);
  drawn.keep(12_000);
  expect(drawn.item).toBe(4);
  expect(drawn.is_behind(5, 21_999)).toBe(false);
});
