// The colours of the trail: which class a point is in, what the legend says, and that the colours can be
// told apart.

import { describe, expect, test } from 'vitest';

import { TRAIL_DARK, TRAIL_LIGHT, TRAIL_SUNLIGHT } from '../src/model/trail_colors';
import { class_of, trail_legend, trail_shades } from '../src/model/trail_shades';
import type { TrailBy } from '../src/model/settings';

const shades = (by: TrailBy, top_mps: number | null = 1.5) => {
  const found = trail_shades(by, top_mps);
  if (!found) throw new Error('in one colour');
  return found;
};

describe('the class of a point', () => {
  test('goes by how far off its way it was, to either side', () => {
    const of = (off_m: number): number => class_of(shades('deviation'), { speed_mps: 9, off_m });
    expect([0, 0.02, 0.021, -0.05, 0.1, 0.2, -0.21, 7].map(of)).toEqual([0, 0, 1, 1, 2, 3, 4, 4]);
    expect(of(NaN)).toBe(5);
  });

  test('or by the speed, of what the vehicle can do', () => {
    const of = (speed_mps: number): number => class_of(shades('speed'), { speed_mps, off_m: 9 });
    expect([0, 0.3, -0.31, 0.9, 1.2, 1.5].map(of)).toEqual([0, 0, 1, 2, 3, 4]);
    expect(of(NaN)).toBe(5);
    expect(shades('speed', 0.6).limits).toEqual([0.12, 0.24, 0.36, 0.48]);
    expect(shades('speed', null).limits).toEqual(shades('speed', 0).limits);
  });

  test('in one colour there is none', () => expect(trail_shades('plain', 1.5)).toBeNull());
});

test('the legend says the ends of the classes in the unit that was chosen', () => {
  expect(trail_legend(shades('deviation'), 'km/h')).toEqual({
    title: 'Off path, cm',
    words: ['≤ 2', '≤ 5', '≤ 10', '≤ 20', '> 20'],
  });
  expect(trail_legend(shades('speed'), 'm/s')).toEqual({
    title: 'Speed, m/s',
    words: ['≤ 0.3', '≤ 0.6', '≤ 0.9', '≤ 1.2', '> 1.2'],
  });
  expect(trail_legend(shades('speed'), 'km/h')).toEqual({
    title: 'Speed, km/h',
    words: ['≤ 1.1', '≤ 2.2', '≤ 3.2', '≤ 4.3', '> 4.3'],
  });
});

/** Relative luminance. Source: WCAG 2.2. */
const luminance = (color: string): number => {
  const part = (k: number): number => {
    const c = parseInt(color.slice(1 + 2 * k, 3 + 2 * k), 16) / 255;
    return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
  };
  return 0.2126 * part(0) + 0.7152 * part(1) + 0.0722 * part(2);
};
const contrast = (a: string, b: string): number => {
  const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y);
  return ((high ?? 0) + 0.05) / ((low ?? 0) + 0.05);
};

describe.each([
  ['light', TRAIL_LIGHT, '#ffffff'],
  ['dark', TRAIL_DARK, '#0d0f13'],
  ['sunlight', TRAIL_SUNLIGHT, '#ffffff'],
] as const)('the colours on %s ground', (name, colors, ground) => {
  test('stand out from it, and go one way in brightness, so that nobody needs to see their hue', () => {
    const against = colors.slice(0, 5).map((color) => contrast(color, ground));
    expect(against[0]).toBeGreaterThan(name === 'sunlight' ? 4.4 : 3);
    against.slice(1).forEach((more, k) => expect(more / (against[k] ?? 0)).toBeGreaterThan(1.2));
  });
});
