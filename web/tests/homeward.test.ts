import { describe, expect, test } from 'vitest';

import { target_words, why_not_home, type WayHome } from '../src/model/homeward';

const way = (given: Partial<WayHome>): WayHome => ({
  target: { lat: 58, lon: 26 },
  target_is: 'home',
  distance_m: 12,
  line: [],
  possible: true,
  reason: '',
  ...given,
});

describe('the way home', () => {
  test('names where it ends', () => {
    expect(target_words(way({}))).toBe('Home');
    expect(target_words(way({ target_is: 'rally_point' }))).toBe('Rally point');
    expect(target_words(way({ target_is: 'begin_of_way' }))).toBe('Where its way began');
    expect(target_words(way({ target_is: null, target: null }))).toBe('Come home');
  });

  test('says why it would do nothing: the robot’s reason, or that it is there', () => {
    expect(why_not_home(way({}))).toBeNull();
    expect(why_not_home(way({ distance_m: null }))).toBeNull();
    expect(why_not_home(way({ possible: false, reason: 'there is no home' }))).toBe(
      'there is no home',
    );
    expect(why_not_home(way({ distance_m: 0.29 }))).toBe('it stands there already (home)');
    expect(why_not_home(way({ distance_m: 0.31 }))).toBeNull();
  });
});
