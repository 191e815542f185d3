import { describe, expect, test } from 'vitest';

import {
  battery_light,
  compass_of,
  instruments_of,
  needle_of,
  radio_view,
  with_instrument,
} from '../src/model/instruments';
import type { Vehicle } from '../src/model/vehicle';

const vehicle = (given: object): Vehicle => given as Vehicle;

describe('instruments', () => {
  test('that were chosen are kept in one order; unknown words are none', () => {
    expect(instruments_of(['rc', 'altitude', 'compass'], [])).toEqual(['compass', 'rc']);
    expect(instruments_of(undefined, ['link'])).toEqual(['link']);
    expect(with_instrument(['rc'], 'attitude', true)).toEqual(['attitude', 'rc']);
    expect(with_instrument(['attitude', 'rc'], 'rc', false)).toEqual(['attitude']);
  });

  test('the compass tells the course only while it goes, and the slip to its left', () => {
    const dial = (speed_mps: number | null, side_slip: number | null = null) =>
      compass_of(
        vehicle({
          position: { heading_deg: 10, speed_mps },
          estimator: { side_slip },
          mission: { bearing_to_item_deg: 20 },
        }),
      );
    expect(dial(0.05)).toEqual({ heading_deg: 10, course_deg: null, bearing_deg: 20 });
    expect(dial(0.8).course_deg).toBe(10);
    expect(dial(-0.8).course_deg).toBe(190);
    // As far to the left as ahead: 45 degrees.
    expect(dial(0.8, 1).course_deg).toBe(325);
  });

  test('the needle stands on the side of the robot, and at its end beyond the limit', () => {
    const needle = (cross_track_m: number | null, cross_track_limit_m: number | null = 3) =>
      needle_of(vehicle({ mission: { cross_track_m, cross_track_limit_m } }));
    expect(needle(0.1)).toEqual({ at: -0.1, end_m: 1 });
    expect(needle(-0.25, 0.5)).toEqual({ at: 0.5, end_m: 0.5 });
    expect(needle(7)?.at).toBe(-1);
    expect(needle(null)).toBeNull();
  });

  test('radio and battery say how they are', () => {
    const radio = (rc: object, control = 'none') => radio_view(vehicle({ rc, control })).word;
    expect(radio({ age_s: null, lost: null, stale: true })).toBe('Not heard');
    expect(radio({ age_s: 0.1, lost: true, stale: false })).toBe('Lost');
    expect(radio({ age_s: 0.1, lost: false, stale: false })).toBe('Heard');
    expect(radio({ age_s: 0.1, lost: false, stale: false }, 'rc')).toBe('It drives');
    const battery = (charge_pct: number | null, fault = false) =>
      battery_light({ charge_pct, fault } as Vehicle['battery']);
    expect([90, 30, 19, null].map((pct) => battery(pct))).toEqual(['good', 'warn', 'bad', 'none']);
    expect(battery(90, true)).toBe('bad');
  });
});
