import { describe, expect, test } from 'vitest';

import { sentence } from '../src/model/format';
import {
  activity_line,
  activity_mark,
  mode_words,
  speed_reason_words,
  why_not_choose,
  why_not_go,
} from '../src/model/modes';
import { why_not_drive, type Facts } from '../src/model/operations';
import type { Activity, Mode, Vehicle } from '../src/model/vehicle';

const activity: Activity = {
  id: 1,
  kind: 'goto',
  state: 'driving',
  reason: '',
  goal: { lat: 58, lon: 26 },
  goal_heading_deg: 90,
  radius_m: null,
  turns: null,
  clockwise: null,
  distance_m: 12.34,
  turn_deg: null,
  target: null,
};
const vehicle = (given: object): Vehicle =>
  ({
    armed: true,
    estop: false,
    mode: 'HOLD',
    home: { lat: 58, lon: 26 },
    activity,
    mission: { state: 'idle' },
    ...given,
  }) as unknown as Vehicle;
const facts = (given: object = {}): Facts => ({ link_stale: false, vehicle: vehicle(given) });

describe('modes', () => {
  test('all have a title and say what the robot does in them', () => {
    for (const { title, does } of Object.values(mode_words)) {
      expect(title).not.toBe('');
      expect(does).toMatch(/\.$/);
    }
  });

  test('what drives by itself needs a robot that is armed; what is driven by hand does not', () => {
    const disarmed = facts({ armed: false });
    for (const mode of ['GUIDED', 'RTL', 'SMART_RTL', 'FOLLOW', 'DOCK'] as const) {
      expect(why_not_choose(disarmed, mode), mode).toBe('Arm the robot first.');
    }
    for (const mode of ['HOLD', 'MANUAL', 'STEERING', 'ACRO', 'SIMPLE'] as const) {
      expect(why_not_choose(disarmed, mode), mode).toBeNull();
    }
    expect(why_not_go(facts())).toBeNull();
  });

  test('HOLD is offered whatever else is wrong', () => {
    const lost: Facts = { link_stale: true, vehicle: vehicle({ estop: true, armed: false }) };
    expect(why_not_choose(lost, 'HOLD')).toBeNull();
    expect(why_not_choose(lost, 'MANUAL')).toBe('No live connection to the robot.');
  });

  test('a return needs a home, a follower its target, a dock its place', () => {
    expect(why_not_choose(facts(), 'RTL')).toBeNull();
    expect(why_not_choose(facts({ home: null }), 'RTL')).toContain('no home');
    expect(why_not_choose(facts(), 'FOLLOW')).toContain('where to follow');
    const told = { activity: { ...activity, target: { lat: 58, lon: 26 } } };
    expect(why_not_choose(facts(told), 'FOLLOW')).toBeNull();
    expect(why_not_choose(facts(), 'DOCK')).toContain('Tap the map');
  });

  test('the pad drives in every mode that is driven by hand', () => {
    const driven = (mode: Mode) => why_not_drive(facts({ mode }));
    for (const mode of ['MANUAL', 'STEERING', 'ACRO', 'SIMPLE'] as const) {
      expect(driven(mode)).toBeNull();
    }
    expect(driven('GUIDED')).not.toBeNull();
  });
});

describe('activity', () => {
  test('a circle says how it is driven, and is drawn around its centre', () => {
    const circle = { ...activity, kind: 'circle' as const, goal_heading_deg: null, radius_m: 3 };
    const endless = { ...circle, clockwise: true, distance_m: null };
    expect(activity_line(vehicle({ activity: endless }))?.detail).toBe(
      '3.00 m around, to the right, no end',
    );
    const twice = { ...circle, clockwise: false, turns: 2 };
    expect(activity_line(vehicle({ activity: twice }))?.detail).toBe(
      '3.00 m around, to the left, 2 turns, 12.3 m left',
    );
    expect(activity_mark(vehicle({ activity: twice }))).toEqual({
      lat: 58,
      lon: 26,
      heading_deg: null,
      ring: { radius_m: 3, clockwise: false },
    });
  });

  test('says what is left while it goes on', () => {
    expect(activity_line(vehicle({}))).toEqual({
      head: 'Going to the place',
      state: 'going',
      detail: '12.3 m left',
    });
    const turning = {
      ...activity,
      kind: 'turn',
      state: 'turning',
      distance_m: null,
      turn_deg: -30,
    };
    expect(activity_line(vehicle({ activity: turning }))?.detail).toBe('30° to the left');
  });

  test('gives the robot’s own reason when it waits or failed', () => {
    const failed = { ...activity, state: 'failed', reason: 'the way is blocked' };
    expect(activity_line(vehicle({ activity: failed }))).toMatchObject({
      state: 'failed',
      detail: 'the way is blocked',
    });
  });

  test('says nothing of what the person ended', () => {
    const ended = (reason: string) =>
      activity_line(vehicle({ activity: { ...activity, state: 'failed', reason } }));
    expect(ended('ended by mode HOLD: by the operator')).toBeNull();
    expect(ended('ended by mode AUTO: mission started')).toBeNull();
    expect(ended('ended by mode HOLD: the position is not known')).not.toBeNull();
  });

  test('is nothing before the first one', () => {
    expect(activity_line(null)).toBeNull();
    expect(activity_line(vehicle({ activity: { ...activity, kind: null } }))).toBeNull();
    expect(activity_line(vehicle({ activity: { ...activity, state: 'none' } }))).toBeNull();
  });

  test('has a mark on the map only while it is under way', () => {
    expect(activity_mark(vehicle({}))).toEqual({ lat: 58, lon: 26, heading_deg: 90 });
    expect(activity_mark(vehicle({ activity: { ...activity, state: 'reached' } }))).toBeNull();
    expect(activity_mark(null)).toBeNull();
  });
});

test('the reason of the speed is said in words, an unknown one as it came', () => {
  expect(speed_reason_words('bend')).toBe('slower in the bend');
  expect(speed_reason_words('some_new_limit')).toBe('some new limit');
});

test('a sentence of the server begins with a capital on the page', () => {
  expect(sentence('drive 3 m straight')).toBe('Drive 3 m straight');
  expect(sentence('')).toBe('');
});
