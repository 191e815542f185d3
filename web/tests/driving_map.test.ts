import { expect, test } from 'vitest';

import { is_loaded, look_of } from '../src/model/draft';
import { fence_near } from '../src/model/fence';

test('the fence is told from ten metres on, and when it is passed', () => {
  expect(fence_near(null)).toBeNull();
  expect(fence_near({ inside: true, distance_m: 10 })).toBeNull();
  expect(fence_near({ inside: true, distance_m: 9.96 })).toBe('fence 10.0 m');
  expect(fence_near({ inside: true, distance_m: 3.24 })).toBe('fence 3.2 m');
  expect(fence_near({ inside: true, distance_m: null })).toBeNull();
  expect(fence_near({ inside: false, distance_m: -0.4 })).toBe('outside the fence');
  expect(fence_near({ inside: false, distance_m: null })).toBe('outside the fence');
});

test('only what the robot has loaded, as it is stored, is its own route', () => {
  const stored = { id: 'a', revision: 3 };
  expect(is_loaded(stored, false, { id: 'a', revision: 3 })).toBe(true);
  expect(is_loaded(stored, true, { id: 'a', revision: 3 })).toBe(false);
  expect(is_loaded(stored, false, { id: 'a', revision: 2 })).toBe(false);
  expect(is_loaded(stored, false, { id: 'b', revision: 3 })).toBe(false);
  expect(is_loaded(stored, false, null)).toBe(false);
  expect(is_loaded(null, false, { id: null, revision: null })).toBe(false);
});

test('while one drives, the route that the robot has is not hidden under its own plan', () => {
  expect(look_of('line', true, true, true)).toEqual({ shape: 'points', faint: false });
  // It could not be read: better the plan than nothing.
  expect(look_of('line', true, true, false)).toEqual({ shape: 'line', faint: false });
  expect(look_of('line', true, false, true)).toEqual({ shape: 'line', faint: true });
  expect(look_of('line', false, true, true)).toEqual({ shape: 'line', faint: false });
  expect(look_of('ring', false, false, false)).toEqual({ shape: 'ring', faint: false });
});
