// What the sensors see: cells, layers, words.

import { describe, expect, it } from 'vitest';

import {
  AT_FIRST,
  cells_of,
  changes_guard,
  guard_line,
  layers_from,
  rates_of,
  sensor_details,
  sensor_line,
  sensor_tone,
  signed_things,
  thing_line,
  type SeenGrid,
  type SeenThing,
  type Sensor,
} from '../src/model/seen';

const grid = (runs: readonly number[], columns: number, rows: number): SeenGrid => ({
  age_s: 0,
  at: null,
  cell_m: 0.1,
  columns,
  rows,
  runs,
});
const bytes = (...values: number[]): readonly number[] => values;

describe('the cells of a grid', () => {
  it('are runs of the kind in the two upper bits, one more than the six lower ones', () => {
    const cells = cells_of(grid(bytes(0x44, 0x80, 0xc0, 0x00), 4, 2));
    expect(Array.from(cells ?? [])).toEqual([1, 1, 1, 1, 1, 2, 3, 0]);
  });
  it('are as many as it says, or none', () => {
    expect(cells_of(grid(bytes(0x44), 2, 2))).toBeNull();
    expect(cells_of(grid(bytes(0x40), 2, 2))).toBeNull();
    expect(cells_of(grid([], 0, 0))?.length).toBe(0);
  });
  it('are refused where the size is absurd', () => {
    expect(cells_of(grid([], 100_000, 100_000))).toBeNull();
    expect(cells_of(grid([], -1, 5))).toBeNull();
    expect(cells_of(grid([], NaN, 5))).toBeNull();
  });
});

describe('the layers', () => {
  it('are remembered, and as at first where nothing or nonsense was kept', () => {
    expect(layers_from('{"scan":true,"grid":false,"map":false,"sound":false}')).toEqual({
      scan: true,
      grid: false,
      map: false,
      sound: false,
    });
    for (const text of [null, '', 'nonsense', 'null', '[]', '{"scan":"yes"}']) {
      expect(layers_from(text)).toEqual(AT_FIRST);
    }
  });
  it('ask the stream for what is shown, and for no more', () => {
    expect(rates_of({ scan: false, grid: false, map: true, sound: true })).toEqual({
      obstacles: 2,
    });
    expect(rates_of({ scan: true, grid: true, map: true, sound: true })).toEqual({
      obstacles: 2,
      grid: 2,
      scan: 5,
    });
  });
});

const front: Sensor = {
  name: 'front',
  kind: 'sick',
  required: true,
  health: 'good',
  reason: '',
  window: 'clean',
  age_s: 0.04,
  rate_hz: 49.8,
  unknown_part: 0.123,
  points: 541,
  refused: 0,
  lost: 0,
  duplicates: 0,
  malformed: 0,
  foreign: 0,
  malformed_last: null,
  malformed_age_s: null,
  mount: { x_m: 0.5, y_m: 0, z_m: 0.3, roll_deg: 0, pitch_deg: 0, yaw_deg: 0 },
};

describe('a sensor', () => {
  it('tells its rate, its age and how much is missing', () => {
    expect(sensor_line(front)).toBe('49.8 Hz · 0.0 s ago · 12 % missing');
    expect(sensor_line({ ...front, age_s: null })).toContain('nothing seen yet');
  });
  it('is bad only where something waits for it', () => {
    expect(sensor_tone(front)).toBe('good');
    expect(sensor_tone({ ...front, health: 'blind' })).toBe('bad');
    expect(sensor_tone({ ...front, health: 'silent', required: false })).toBe('warn');
    expect(sensor_tone({ ...front, health: 'degraded' })).toBe('warn');
  });
  it('tells only the losses that there were, and why something was refused last', () => {
    const told = (sensor: Sensor) =>
      sensor_details(sensor).map(([name, value]) => `${name}: ${value}`);
    expect(told(front)).toContain('Lost or refused: nothing');
    const bad = {
      ...front,
      lost: 12,
      malformed: 3,
      malformed_last: 'wrong checksum',
      malformed_age_s: 4.2,
    };
    const lines = told(bad);
    expect(lines).toContain('Lost on the way: 12');
    expect(lines).toContain('Refused, damaged: 3');
    expect(lines).toContain('Refused last: Wrong checksum (4.2 s ago)');
    expect(lines.some((line) => line.startsWith('Came twice'))).toBe(false);
  });
});

describe('a thing', () => {
  const pole: SeenThing = {
    what: 'obstacle',
    lat: 58,
    lon: 26,
    distance_m: 1.24,
    bearing_deg: -31.4,
    clearance_m: 0.7,
    size_m: 0.4,
    age_s: 0.1,
    sensor: 'front',
    on_way: false,
  };
  it('is told with its distance, direction, width and by whom', () => {
    expect(thing_line(pole)).toBe('Obstacle 1.2 m, 31° left · 0.4 m wide · front');
    expect(thing_line({ ...pole, bearing_deg: 4, sensor: null })).toBe(
      'Obstacle 1.2 m, ahead · 0.4 m wide',
    );
    expect(thing_line({ ...pole, bearing_deg: 178, what: 'drop', age_s: 12 })).toBe(
      'Ground ends 1.2 m, behind · 0.4 m wide · front, 12 s ago',
    );
  });
  it('gets no sign where a nearer one stands, unless it is on the way', () => {
    const at = (distance_m: number, on_way = false): SeenThing => ({ ...pole, distance_m, on_way });
    const things = [at(1), at(1.2), at(1.3, true), at(3), at(3.1)];
    const apart = (one: SeenThing, other: SeenThing): boolean =>
      Math.abs(one.distance_m - other.distance_m) > 0.5;
    expect(signed_things(things, apart).map(({ distance_m }) => distance_m)).toEqual([1.3, 3]);
  });
});

describe('the guard', () => {
  it('tells by what it reckons, and what of it acts at once', () => {
    const figures = {
      back_m: 0.5,
      side_m: 0.08,
      gap_m: 0.3,
      delay_s: 0.2,
      decel_mps2: 0.6,
      turn_decel_dps2: 24,
    };
    const line = guard_line(figures);
    expect(line).toContain('0.30 m before and 0.08 m beside');
    expect(line).toContain('act at once');
    expect(changes_guard('safety_parameter')).toBe(true);
    expect(changes_guard('obstacle')).toBe(false);
  });
});
