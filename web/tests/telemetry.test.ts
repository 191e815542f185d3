import { describe, expect, test } from 'vitest';

import { add_sample, empty_columns } from '../src/model/columns';
import {
  radio_lines,
  receiver_place,
  robot_place,
  worth_a_word,
  type Rc,
  type Vehicle,
} from '../src/model/vehicle';

describe('columns', () => {
  test('hold one column per signal, bounded, with gaps for unknown values', () => {
    const columns = empty_columns(2);
    for (let t = 1; t <= 4; t += 1) add_sample(columns, 3, t, [t * 10, t === 3 ? null : t]);
    expect(columns).toEqual([
      [2, 3, 4],
      [20, 30, 40],
      [2, null, 4],
    ]);
  });

  test('refuse a sample that is not later than the last', () => {
    const columns = empty_columns(1);
    expect(add_sample(columns, 3, 5, [1])).toBe(true);
    expect(add_sample(columns, 3, 5, [2])).toBe(false);
    expect(columns[0]).toEqual([5]);
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
