import { describe, expect, test } from 'vitest';

import {
  csv_of,
  heading_error_deg,
  KEPT,
  pair_of,
  sample_of,
  shown_pair_of,
  SIGNALS,
  Telemetry,
  value_range,
} from '../src/model/telemetry';
import { event_about, worth_a_word } from '../src/model/happened';
import {
  radio_lines,
  receiver_place,
  robot_place,
  type Rc,
  type Vehicle,
} from '../src/model/vehicle';

/** Driving north to its item in the north-east. */
const driving = (given: object = {}): Vehicle =>
  ({
    position: { speed_mps: 0.8, heading_deg: 0, stale: false, ...given },
    mission: {
      state: 'running',
      cross_track_m: -0.1,
      bearing_to_item_deg: 45,
      distance_to_item_m: 10,
    },
    battery: { battery_v: 52.5, stale: false },
    gnss: { horizontal_accuracy_m: 0.02, stale: false },
  }) as unknown as Vehicle;

describe('telemetry', () => {
  test('is one column per signal, with gaps for what is not known or old', () => {
    const telemetry = new Telemetry();
    telemetry.take(1, sample_of(driving(), 0.05));
    telemetry.take(2, sample_of(driving({ stale: true }), null));
    expect(telemetry.columns).toEqual([
      [1, 2],
      [0.8, null],
      [-0.1, null],
      [45, null],
      [52.5, 52.5],
      [50, null],
      [0.02, 0.02],
    ]);
  });

  test('keeps five minutes at ten a second, and takes nothing that is not later', () => {
    const telemetry = new Telemetry();
    for (let k = 0; k < 10_000; k += 1) telemetry.take(k / 10, [k]);
    expect(telemetry.take(999.9, [0])).toBe(false);
    const [times] = telemetry.columns;
    expect(times.at(-1)).toBe(999.9);
    expect(times.length).toBeGreaterThanOrEqual(KEPT);
    expect(times.length).toBeLessThanOrEqual(KEPT + 200);
    expect(telemetry.columns.every((column) => column.length === times.length)).toBe(true);
  });

  test('is plotted in the unit of the device, and kept and saved as it was measured', () => {
    const telemetry = new Telemetry();
    telemetry.take(1, [0.5, 2]);
    telemetry.take(2, [null, 3]);
    const [speed, deviation] = SIGNALS;
    expect(shown_pair_of(telemetry.columns, speed, 'km/h')).toEqual([
      [1, 2],
      [1.8, null],
    ]);
    expect(shown_pair_of(telemetry.columns, deviation, 'km/h')[1]).toEqual([2, 3]);
    expect(shown_pair_of(telemetry.columns, speed, 'm/s')[1]).toEqual([0.5, null]);
    expect(csv_of(telemetry.columns)).toContain('speed_mps');
  });

  test('stands still while it is looked at', () => {
    const telemetry = new Telemetry();
    telemetry.take(1, [5]);
    const frozen = telemetry.frozen();
    telemetry.take(2, [6]);
    expect(pair_of(frozen, 'speed')).toEqual([[1], [5]]);
    expect(pair_of(telemetry.columns, 'speed')).toEqual([
      [1, 2],
      [5, 6],
    ]);
  });

  test('is saved with units, UTC and nothing where nothing is known', () => {
    const telemetry = new Telemetry();
    telemetry.take(0.5, [0.81234567, null, -12, 52, 4, 0.02]);
    expect(csv_of(telemetry.columns)).toBe(
      'time,speed_mps,deviation_m,heading_error_deg,battery_V,link_ms,gnss_m\r\n' +
        '1970-01-01T00:00:00.500Z,0.8123,,-12,52,4,0.02\r\n',
    );
  });

  test('tells the heading error the short way round, of the tail where it backs', () => {
    expect(heading_error_deg(driving({ heading_deg: 350 }))).toBe(55);
    expect(heading_error_deg(driving({ heading_deg: 225, speed_mps: -0.5 }))).toBe(0);
    expect(heading_error_deg(driving({ heading_deg: 225 }))).toBe(-180);
    expect(heading_error_deg(driving({ heading_deg: null }))).toBeNull();
  });
});

describe('vehicle', () => {
  test('has no place while one coordinate is unknown', () => {
    const at = (lat: number | null, lon: number | null) =>
      robot_place({ position: { lat, lon } } as Vehicle);
    expect(at(58, 26)).toEqual({ lat: 58, lon: 26 });
    expect(at(0, 0)).toEqual({ lat: 0, lon: 0 });
    expect(at(null, 26)).toBeNull();
    expect(robot_place(null)).toBeNull();
  });

  test('has no receiver place without a fresh fix', () => {
    const received = (fix: string, stale: boolean) =>
      receiver_place({ gnss: { lat: 58, lon: 26, fix, stale } } as unknown as Vehicle);
    expect(received('gps', false)).toEqual({ lat: 58, lon: 26 });
    expect(received('none', false)).toBeNull();
    expect(received('rtk_fixed', true)).toBeNull();
  });

  test('says of each radio switch that was heard how it stands and what that does', () => {
    const positions = { swa: 'up', swb: 'middle', swc: null, swd: 'down', vra: -0.5 };
    const meaning = {
      swa: null,
      swb: 'the sticks drive',
      swc: 'mode AUTO',
      swd: 'arm',
      vra: 'clear',
    };
    expect(radio_lines({ ...positions, meaning } as unknown as Rc)).toEqual([
      { name: 'SWB', position: 'middle', meaning: 'the sticks drive' },
      { name: 'SWD', position: 'down', meaning: 'arm' },
      { name: 'VRA', position: 'at -50 %', meaning: 'clear' },
    ]);
    expect(radio_lines(undefined)).toEqual([]);
  });

  test('tells bad news and the good news one waits for, but not its own echo', () => {
    const event = (level: 'info' | 'warning' | 'error', kind: string) =>
      worth_a_word({ time: '', level, kind, detail: '' });
    expect(event('info', 'item_reached')).toBe(false);
    expect(event('info', 'mission_finished')).toBe(true);
    expect(event('error', 'blocked')).toBe(true);
    expect(event('warning', 'arm_refused')).toBe(false);
  });
});

test('an axis shows a battery that sags, and does not make a robot that stands move', () => {
  const [low, high] = value_range(52.6, 52.7);
  expect(low).toBeGreaterThan(52);
  expect(high).toBeLessThan(53.3);
  expect(high - low).toBeGreaterThan(1);
  const [least, most] = value_range(0, 0.003);
  expect(most - least).toBeCloseTo(0.22, 2);
  expect(value_range(null, null)).toEqual([0, 1]);
  const [from, to] = value_range(-1, 3);
  expect(from).toBeLessThan(-1);
  expect(to).toBeGreaterThan(3);
});

test('what a driver that comes and goes says is one message, the newest', () => {
  const about = (kind: string, detail: string) =>
    event_about({ time: '', level: 'warning', kind, detail });
  expect(about('driver_down', 'top: no packet of the sensor')).toBe('driver top');
  expect(about('driver_failed', 'top: it hangs')).toBe('driver top');
  expect(about('driver_up', 'top is up')).toBe('driver top');
  expect(about('driver_down', 'front: silent')).not.toBe('driver top');
  expect(about('obstacle', 'something, 0.8 m ahead')).toBe(
    about('obstacle', 'something, 12 m ahead'),
  );
  expect(about('known_place', 'gate fits')).not.toBe(about('known_place', 'door fits'));
});
