import { describe, expect, test } from 'vitest';

import { covered_px } from '../src/model/screen';

describe("a phone's keyboard", () => {
  test('covers what is not seen of the page', () => {
    expect(covered_px(844, { height: 508.4, offsetTop: 0, scale: 1 })).toBe(336);
    // A phone that pushes the page up for the field shows the lower part of it.
    expect(covered_px(844, { height: 508, offsetTop: 100, scale: 1 })).toBe(236);
  });
  test('covers nothing where it is not there, not known, or makes the page smaller itself', () => {
    expect(covered_px(844, { height: 844, offsetTop: 0, scale: 1 })).toBe(0);
    expect(covered_px(844, { height: 900, offsetTop: 0, scale: 1 })).toBe(0);
    expect(covered_px(844, null)).toBe(0);
  });
  test('is not what two fingers do', () => {
    expect(covered_px(844, { height: 422, offsetTop: 100, scale: 2 })).toBe(0);
  });
});
