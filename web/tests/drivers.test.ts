import { describe, expect, test } from 'vitest';

import {
  driver_details,
  driver_line,
  driver_tone,
  driver_troubles,
  type Driver,
} from '../src/model/drivers';

const driver = (change: Partial<Driver> = {}): Driver => ({
  name: 'bunker',
  state: 'up',
  reason: '',
  link: { address: 'can:can0', open: true },
  rate_hz: 282.4,
  rates_hz: { '0x221': 50 },
  counts: { 'too short': 3 },
  facts: { control_mode: 'standby' },
  hazards: [],
  restarts: 0,
  last_error: null,
  recording: 'off',
  recording_problem: '',
  age_s: 0.1,
  ...change,
});

describe('drivers', () => {
  test('one line says when it was heard, how often, and that it was restarted', () => {
    expect(driver_line(driver())).toBe('heard 0.1 s ago · 282 Hz');
    expect(driver_line(driver({ age_s: null, rate_hz: null }))).toBe('not heard yet · —');
    expect(driver_line(driver({ restarts: 1 }))).toMatch(/ · restarted once$/);
    expect(driver_line(driver({ restarts: 4 }))).toMatch(/ · restarted 4 times$/);
  });

  test('a hazard or a failure is bad, what tries again is a warning', () => {
    expect(driver_tone(driver())).toBe('good');
    expect(driver_tone(driver({ state: 'faulty' }))).toBe('warn');
    expect(driver_tone(driver({ state: 'failed' }))).toBe('bad');
    expect(driver_tone(driver({ hazards: ['left and right are swapped'] }))).toBe('bad');
  });

  test('troubles stand in words, the hazard first', () => {
    expect(driver_troubles(driver())).toEqual([]);
    const all = driver({
      hazards: ['somebody else sends 0x111'],
      reason: 'no 0x211',
      recording: 'stopped',
      recording_problem: 'No space left on device',
    });
    expect(driver_troubles(all)).toEqual([
      'somebody else sends 0x111',
      'no 0x211',
      'Not recorded: No space left on device',
    ]);
  });

  test('details are pairs of a name and a value', () => {
    const all = driver({ recording: 'on', last_error: { detail: 'no 0x211', age_s: 65 } });
    expect(driver_details(all)).toEqual([
      ['Link', 'can:can0, open'],
      ['control mode', 'standby'],
      ['Rates', '0x221 50.0 Hz'],
      ['too short', '3'],
      ['Recording', 'on'],
      ['Last error', '65 s ago: no 0x211'],
    ]);
  });
});
