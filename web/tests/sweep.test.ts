// Over which ground the vehicle comes before it stands.

import { describe, expect, it } from 'vitest';

import { offset_between } from '../src/model/geo';
import { along, stopping_s, sweep_of, type GuardFigures } from '../src/model/sweep';

const HERE = { lat: 58.378, lon: 26.729 };
const SIZE = { length_m: 1, width_m: 0.8 };
const GUARD: GuardFigures = {
  back_m: 0.5,
  side_m: 0.08,
  gap_m: 0.2,
  delay_s: 0.2,
  decel_mps2: 0.6,
  turn_decel_dps2: 24,
};

describe('the time until it stands', () => {
  it('is the delay and half of what braking takes: so its way is v·delay + v²/2a', () => {
    const twist = { speed_mps: 1.2, yaw_rate_dps: 0 };
    expect(1.2 * stopping_s(twist, GUARD)).toBeCloseTo(1.2 * 0.2 + (1.2 * 1.2) / (2 * 0.6), 9);
    expect(stopping_s({ speed_mps: -1.2, yaw_rate_dps: 0 }, GUARD)).toBeCloseTo(1.2, 9);
  });
  it('is that of the turn where that takes longer', () => {
    expect(stopping_s({ speed_mps: 0.1, yaw_rate_dps: 48 }, GUARD)).toBeCloseTo(1.2, 9);
  });
});

describe('along a twist', () => {
  it('goes straight, on an arc, and turns on the spot', () => {
    expect(along({ speed_mps: 0.5, yaw_rate_dps: 0 }, 2)).toEqual({
      ahead_m: 1,
      left_m: 0,
      turn_rad: 0,
    });
    // A quarter of a circle of 1 m about a point to the left.
    const quarter = along({ speed_mps: Math.PI / 2, yaw_rate_dps: 90 }, 1);
    expect(quarter.ahead_m).toBeCloseTo(1, 9);
    expect(quarter.left_m).toBeCloseTo(1, 9);
    expect(quarter.turn_rad).toBeCloseTo(Math.PI / 2, 9);
    expect(along({ speed_mps: 0, yaw_rate_dps: 90 }, 1).ahead_m).toBe(0);
  });
});

describe('the swept ground', () => {
  it('begins with the vehicle and ends where it stands, with the gap before it', () => {
    const sweep = sweep_of(HERE, 0, { speed_mps: 0.6, yaw_rate_dps: 0 }, SIZE, GUARD);
    const first = offset_between(HERE, sweep?.outlines[0]?.[0] ?? HERE);
    expect(first.north_m).toBeCloseTo(0.5, 4);
    expect(first.east_m).toBeCloseTo(-0.4, 4); // the front left corner, looking north
    const way_m = 0.6 * 0.2 + 0.36 / 1.2;
    const last = offset_between(HERE, sweep?.outlines.at(-1)?.[0] ?? HERE);
    expect(last.north_m).toBeCloseTo(0.5 + way_m, 4);
    const margin = offset_between(HERE, sweep?.margin[0] ?? HERE);
    expect(margin.north_m).toBeCloseTo(0.5 + way_m + 0.2, 4);
    expect(margin.east_m).toBeCloseTo(-0.48, 4);
  });
  it('has its gap behind in reverse, and follows how the robot faces', () => {
    const sweep = sweep_of(HERE, 90, { speed_mps: -0.6, yaw_rate_dps: 0 }, SIZE, GUARD);
    const rear = offset_between(HERE, sweep?.margin[1] ?? HERE); // rear left
    expect(rear.east_m).toBeCloseTo(-(0.5 + 0.42 + 0.2), 4);
    expect(rear.north_m).toBeCloseTo(0.48, 4);
  });
  it('is none of a robot that stands, or does not know where', () => {
    expect(sweep_of(HERE, 0, { speed_mps: 0, yaw_rate_dps: 0 }, SIZE, GUARD)).toBeNull();
    const ahead = { speed_mps: 1, yaw_rate_dps: 0 };
    expect(sweep_of(null, 0, ahead, SIZE, GUARD)).toBeNull();
    expect(sweep_of(HERE, null, ahead, SIZE, GUARD)).toBeNull();
  });
});
