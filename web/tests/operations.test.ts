import { describe, expect, test } from 'vitest';

import { DEAD_ZONE, drive_wish, wish_of_keys } from '../src/model/drive';
import {
  only_position_fails,
  why_not_acknowledge,
  why_not_arm,
  why_not_drive,
  why_not_load,
  why_not_mode,
  why_not_pause,
  why_not_reset_stop,
  why_not_resume,
  why_not_skip,
  why_not_start,
  why_not_stop_mission,
  type Facts,
} from '../src/model/operations';
import type { ExecutionState, Vehicle } from '../src/model/vehicle';
import { row_window, scroll_to_row } from '../src/model/window';

interface Given {
  readonly stale?: boolean;
  readonly armed?: boolean;
  readonly estop?: boolean;
  readonly mode?: string;
  readonly state?: ExecutionState;
  readonly waits_for_word?: boolean;
}
const facts = ({ stale, armed, estop, mode, state, waits_for_word }: Given): Facts => ({
  link_stale: stale ?? false,
  vehicle: {
    armed: armed ?? false,
    estop: estop ?? false,
    mode: mode ?? 'HOLD',
    mission: { state: state ?? 'idle', waits_for_word: waits_for_word ?? false },
  } as unknown as Vehicle,
});

describe('operations', () => {
  test('without control nothing is offered but what stops or holds', () => {
    const ready = facts({ armed: true, mode: 'MANUAL', state: 'paused' });
    const other = { ...ready, no_control: 'anna has control' };
    for (const why of [why_not_arm, why_not_start, why_not_resume, why_not_skip, why_not_drive]) {
      expect(why(ready)).toBeNull();
      expect(why(other)).toBe('anna has control');
    }
    const latched = { ...facts({ estop: true }), no_control: 'anna has control' };
    expect(why_not_reset_stop(latched)).toBe('anna has control');
    expect(why_not_mode(other, 'AUTO')).toBe('anna has control');
    expect(why_not_mode(other, 'HOLD')).toBeNull();
    expect(why_not_pause({ ...facts({ state: 'running' }), no_control: 'anna' })).toBeNull();
    expect(why_not_stop_mission(other)).toBeNull();
  });

  test('nothing that moves the robot is offered without a live link', () => {
    const silent = facts({ stale: true, armed: true, mode: 'MANUAL', state: 'paused' });
    for (const reason of [
      why_not_arm(silent),
      why_not_mode(silent, 'MANUAL'),
      why_not_start(silent),
      why_not_resume(silent),
      why_not_skip(silent),
      why_not_drive(silent),
      why_not_load(silent, true, 3),
    ]) {
      expect(reason).toBe('No live connection to the robot.');
    }
    expect(why_not_arm({ link_stale: false, vehicle: null })).not.toBeNull();
  });

  test('there is something to look at while the estimate is latched', () => {
    const waits = (...ids: string[]): Facts => ({
      link_stale: false,
      vehicle: { safety: ids.map((id) => ({ id, detail: '' })) } as unknown as Vehicle,
    });
    expect(why_not_acknowledge(waits('gnss_lost'))).toBe('There is nothing to look at.');
    expect(why_not_acknowledge(waits('gnss_lost', 'estimate_latched'))).toBeNull();
  });

  test('what makes the robot stop is offered even when the link is silent', () => {
    const silent = facts({ stale: true, state: 'running' });
    expect(why_not_mode(silent, 'HOLD')).toBeNull();
    expect(why_not_pause(silent)).toBeNull();
    expect(why_not_stop_mission(silent)).toBeNull();
  });

  test('a blocked mission stands like a paused one: it goes on, or is stopped or replaced', () => {
    for (const state of ['paused', 'blocked'] as const) {
      const waiting = facts({ armed: true, state });
      expect(why_not_resume(waiting)).toBeNull();
      expect(why_not_stop_mission(waiting)).toBeNull();
      expect(why_not_load(waiting, true, 3)).toBeNull();
      expect(why_not_pause(waiting)).toBe('No mission is running.');
    }
    expect(why_not_resume(facts({ armed: true, state: 'running' }))).not.toBeNull();
    const stays = facts({ armed: true, state: 'running', waits_for_word: true });
    expect(why_not_resume(stays)).toBeNull();
  });

  test('a latched stop refuses everything but its reset', () => {
    const stopped = facts({ estop: true, armed: true, mode: 'MANUAL', state: 'paused' });
    for (const reason of [
      why_not_arm(stopped),
      why_not_mode(stopped, 'MANUAL'),
      why_not_start(stopped),
      why_not_resume(stopped),
      why_not_drive(stopped),
    ]) {
      expect(reason).toContain('latched');
    }
    expect(why_not_reset_stop(stopped)).toBeNull();
    expect(why_not_reset_stop(facts({}))).not.toBeNull();
  });

  test('a mission is loaded from what is stored, and not while one runs', () => {
    expect(why_not_load(facts({}), true, 0)).toContain('no items');
    expect(why_not_load(facts({}), false, 3)).toContain('Save');
    expect(why_not_load(facts({ state: 'running' }), true, 3)).toContain('stop it first');
    expect(why_not_load(facts({ state: 'paused' }), true, 3)).toBeNull();
  });

  test('a start needs a loaded mission and an armed robot', () => {
    expect(why_not_start(facts({ armed: true }))).toBe('Load a mission first.');
    expect(why_not_start(facts({ state: 'loaded' }))).toBe('Arm the robot first.');
    expect(why_not_start(facts({ state: 'running', armed: true }))).toContain('already');
    expect(why_not_start(facts({ state: 'finished', armed: true }))).toBeNull();
  });

  test('driving by hand needs an armed robot in MANUAL', () => {
    expect(why_not_drive(facts({ mode: 'MANUAL' }))).toBe('Arm the robot first.');
    expect(why_not_drive(facts({ armed: true }))).toContain('MANUAL');
    expect(why_not_drive(facts({ armed: true, mode: 'MANUAL' }))).toBeNull();
  });
});

describe('drive pad', () => {
  const limits = { max_speed_mps: 1.5, max_yaw_rate_dps: 60 };

  test('up is forward, right is clockwise, the middle is nothing', () => {
    expect(drive_wish(0, 1, limits, 1)).toEqual({ speed_mps: 1.5, yaw_rate_dps: 0 });
    expect(drive_wish(1, 0, limits, 0.5)).toEqual({ speed_mps: 0, yaw_rate_dps: -30 });
    expect(drive_wish(DEAD_ZONE, -DEAD_ZONE, limits, 1)).toEqual({ speed_mps: 0, yaw_rate_dps: 0 });
  });

  test('never asks for more than the limits', () => {
    expect(drive_wish(-5, -5, limits, 1)).toEqual({ speed_mps: -1.5, yaw_rate_dps: 60 });
  });

  test('opposite keys cancel', () => {
    expect(wish_of_keys(new Set(['ArrowUp', 's']), limits, 1).speed_mps).toBe(0);
    expect(wish_of_keys(new Set(['w', 'a']), limits, 1)).toEqual({
      speed_mps: 1.5,
      yaw_rate_dps: 60,
    });
  });
});

describe('long lists', () => {
  test('make only the rows in sight and a few beyond', () => {
    const { first, end } = row_window(10_000, 46, 46 * 5000, 322);
    expect(first).toBeGreaterThan(4980);
    expect(end).toBeLessThan(5020);
    expect(row_window(3, 46, 0, 322)).toEqual({ first: 0, end: 3 });
    expect(row_window(0, 46, 500, 322)).toEqual({ first: 0, end: 0 });
  });

  test('scroll as little as possible to show a row', () => {
    expect(scroll_to_row(0, 46, 100, 322)).toBe(0);
    expect(scroll_to_row(3, 46, 0, 322)).toBe(0);
    expect(scroll_to_row(20, 46, 0, 322)).toBe(20 * 46 + 46 - 322);
  });
});

describe('arming to drive by hand', () => {
  const check = (id: string, ok: boolean, severity: 'error' | 'warning' = 'error') => ({
    id,
    ok,
    severity,
    detail: '',
  });
  test('is offered where nothing but the position speaks against arming', () => {
    expect(only_position_fails([check('gnss_fix', false), check('radio', true)])).toBe(true);
    expect(
      only_position_fails([
        check('gnss_fix', false),
        check('position_accuracy', false),
        check('heading', false, 'warning'),
      ]),
    ).toBe(true);
    expect(only_position_fails([check('gnss_fix', false), check('radio', false)])).toBe(false);
    expect(only_position_fails([check('gnss_fix', true)])).toBe(false);
    expect(only_position_fails([])).toBe(false);
  });
});
