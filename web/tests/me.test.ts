// The phone's place: what is believed of it, and what the robot is told.

import { describe, expect, it } from 'vitest';

import { bearing_deg, distance_m, offset_from } from '../src/model/geo';
import { kept_m, my_target, why_not_here, with_fix, type Fix, type Me } from '../src/model/me';

const ORIGIN = { lat: 58.378, lon: 26.729 };

const fix = (s: number, east_m = 0, north_m = 0, accuracy_m = 4): Fix => ({
  ...offset_from(ORIGIN, { east_m, north_m }),
  accuracy_m,
  at_ms: s * 1000,
});
const me_of = (...fixes: Fix[]): Me => fixes.reduce<Me>((me, one) => with_fix(me, one), []);

describe('what is believed', () => {
  it('waits for the first place', () => {
    expect(why_not_here([], 0, null)).toMatch(/not found its place/);
  });
  it('takes a place of three seconds and ten metres, and no older or wider one', () => {
    const me = me_of(fix(10, 0, 0, 10));
    expect(why_not_here(me, 13_000, null)).toBeNull();
    expect(why_not_here(me, 13_600, null)).toMatch(/for 4 s/);
    expect(why_not_here(me_of(fix(10, 0, 0, 10.5)), 10_000, null)).toMatch(
      /within 11 m; it must be 10 m/,
    );
  });
  it('says what the browser does not allow before anything else', () => {
    const me = me_of(fix(10));
    expect(why_not_here(me, 10_000, 'denied')).toMatch(/settings/);
    expect(why_not_here([], 0, 'insecure')).toMatch(/HTTPS/);
  });
  it('stays with a fresh place when one try fails', () => {
    const me = me_of(fix(10));
    expect(why_not_here(me, 12_000, 'unavailable')).toBeNull();
    expect(why_not_here(me, 13_500, 'unavailable')).toMatch(/does not find/);
    expect(why_not_here([], 0, 'unavailable')).toMatch(/does not find/);
  });
  it('leaves out what is no place or comes out of order', () => {
    const me = me_of(fix(10), fix(9, 50), { ...fix(11), lat: Number.NaN }, fix(11, 0, 0, -1));
    expect(me).toEqual([fix(10)]);
  });
});

describe('what the robot is told', () => {
  const robot = offset_from(ORIGIN, { east_m: 0, north_m: 30 });

  it('is on the robot’s side of the circle in which the phone may be', () => {
    const told = my_target(me_of(fix(10)), robot, 10_000);
    expect(told).not.toBeNull();
    if (!told) return;
    expect(distance_m(ORIGIN, told)).toBeCloseTo(4, 2);
    expect(bearing_deg(ORIGIN, told)).toBeCloseTo(0, 1);
    expect(told.speed_mps).toBe(0);
  });
  it('is the robot’s own place where that may be the person’s', () => {
    const near = offset_from(ORIGIN, { east_m: 3, north_m: 0 });
    const told = my_target(me_of(fix(10)), near, 10_000);
    expect(told && distance_m(near, told)).toBeCloseTo(0, 2);
  });
  it('moves by a metre at most when the phone becomes less sure', () => {
    const less_sure = me_of(fix(10, 0, 0, 3), fix(11, 0, 0, 8));
    expect(kept_m(less_sure, null)).toBe(8);
    expect(kept_m(less_sure, 3)).toBe(4);
    expect(kept_m(less_sure, 7.5)).toBe(8);
    expect(kept_m(me_of(fix(10, 0, 0, 3)), 8)).toBe(7);
    const told = my_target(less_sure, robot, 11_000, 4);
    expect(told && distance_m(ORIGIN, told)).toBeCloseTo(4, 2);
  });
  it('goes on for a second as the person walks, and no longer', () => {
    const me = me_of(fix(10, 0, 0, 0), fix(11, 1.4, 0, 0), fix(12, 2.8, 0, 0));
    const at = (ms: number): number => {
      const told = my_target(me, offset_from(ORIGIN, { east_m: 60, north_m: 0 }), ms);
      return told ? distance_m(ORIGIN, told) : Number.NaN;
    };
    expect(at(12_000)).toBeCloseTo(2.8, 2);
    expect(at(12_500)).toBeCloseTo(3.5, 2);
    expect(at(13_500)).toBeCloseTo(4.2, 2);
    expect(at(13_700)).toBeNaN(); // the robot brakes a second later
    const told = my_target(me, robot, 12_000);
    expect(told?.speed_mps).toBeCloseTo(1.4, 2);
    expect(told?.heading_deg).toBeCloseTo(90, 0);
  });
  it('takes a place that wanders for one that stands, and no jump for a run', () => {
    const wanders = me_of(fix(10, 0, 0), fix(11, 0.3, 0.2), fix(12, 0.4, -0.1));
    expect(my_target(wanders, robot, 12_000)?.speed_mps).toBe(0);
    const jumps = me_of(fix(10, 0, 0), fix(11, 40, 0));
    expect(my_target(jumps, robot, 11_000)?.speed_mps).toBeCloseTo(3, 6);
  });
  it('forgets how somebody walked before he stood', () => {
    const me = me_of(fix(10), fix(11, 1.4), fix(15, 1.4), fix(16, 1.4));
    expect(my_target(me, robot, 16_000)?.speed_mps).toBe(0);
  });
  it('is nothing while the one or the other is not known', () => {
    expect(my_target([], robot, 0)).toBeNull();
    expect(my_target(me_of(fix(10)), null, 10_000)).toBeNull();
  });
});
