import { describe, expect, test } from 'vitest';

import {
  compared,
  file_of,
  group_of,
  label_of,
  grouped,
  is_changed,
  range_text,
  short_name,
  typed,
  waits_for_start,
  type Parameter,
} from '../src/model/parameters';

const parameter = (name: string, given: Partial<Parameter> = {}): Parameter => {
  const value = given.value ?? 1;
  return {
    name,
    type: 'number',
    unit: 'm',
    value,
    default: 1,
    next_start_value: value,
    min: 0,
    max: 5,
    description: 'How far it may be off.',
    acts: 'at_once',
    stricter: null,
    ...given,
  };
};
const off = parameter('nav.track.corner_deviation_m', { value: 2 });
const width = parameter('vehicle.width_m', { next_start_value: 0.9, acts: 'at_next_start' });
const radio = parameter('safety.radio_needed', {
  type: 'boolean',
  unit: null,
  value: true,
  default: true,
  min: null,
  max: null,
  description: 'Nothing drives without the radio.',
});
const all = [width, radio, off];

describe('the list', () => {
  test('is sorted into groups', () => {
    expect(group_of('nav.track.damping')).toBe('nav.track');
    expect(short_name('nav.track.corner_deviation_m')).toBe('corner deviation m');
    expect(label_of(off)).toBe('corner deviation m');
    expect(label_of({ ...off, name: 'nav.gain', unit: '1/s' })).toBe('gain, 1/s');
    expect(grouped(all, '', false).map(({ name }) => name)).toEqual([
      'nav.track',
      'safety',
      'vehicle',
    ]);
  });
  test('is searched by name and meaning', () => {
    const found = (text: string) =>
      grouped(all, text, false).flatMap(({ items }) => items.map(({ name }) => name));
    expect(found('RADIO drives')).toEqual(['safety.radio_needed']);
    expect(found('corner deviation')).toEqual(['nav.track.corner_deviation_m']);
    expect(found('corner radio')).toEqual([]);
  });
  test('tells what is not as the vehicle comes, also before it acts', () => {
    expect(all.map(is_changed)).toEqual([true, false, true]);
    expect(all.map(waits_for_start)).toEqual([true, false, false]);
    expect(grouped(all, '', true).map(({ name }) => name)).toEqual(['nav.track', 'vehicle']);
  });
  test('tells the range in its unit', () => {
    expect(range_text(off)).toBe('0 … 5 m');
    expect(range_text({ ...off, max: null })).toBe('from 0 m');
    expect(range_text({ ...off, min: null, unit: null })).toBe('to 5');
    expect(range_text(radio)).toBe('');
  });
});

describe('what is typed', () => {
  test('is a number within its range', () => {
    expect(typed(off, ' 0,5 ')).toEqual({ ok: true, value: 0.5 });
    expect(typed(off, '5.1')).toEqual({ ok: false, why: 'must be in 0 … 5 m' });
    for (const text of ['', 'x', 'Infinity', '1e999']) expect(typed(off, text).ok).toBe(false);
    expect(typed({ ...off, type: 'integer' }, '1.5')).toEqual({
      ok: false,
      why: 'must be a whole number',
    });
  });
  test('is on or off, or any text', () => {
    expect(typed(radio, 'off')).toEqual({ ok: true, value: false });
    expect(typed(radio, 'maybe').ok).toBe(false);
    expect(typed({ ...off, type: 'text' }, '')).toEqual({ ok: true, value: '' });
  });
});

describe('a file', () => {
  test('of this robot changes nothing in it', () => {
    expect(compared(file_of(all), all)).toEqual({ differ: [], left_out: [] });
  });
  test('of another one tells what differs, and what does not fit here', () => {
    const file = JSON.stringify({
      format: 'roverd-parameters',
      parameters: {
        'nav.track.corner_deviation_m': 3,
        'safety.radio_needed': 'yes',
        'vehicle.width_m': 99,
        'vehicle.wings': 2,
      },
    });
    expect(compared(file, all)).toEqual({
      differ: [{ parameter: off, value: 3 }],
      left_out: [
        { name: 'safety.radio_needed', why: 'must be on or off' },
        { name: 'vehicle.width_m', why: 'must be in 0 … 5 m' },
        { name: 'vehicle.wings', why: 'is not known here' },
      ],
    });
  });
  test('that is none is said to be none', () => {
    for (const text of ['', '{', 'null', '[]', '7', '{"format":"other"}']) {
      expect(compared(text, all)).toBe('This is no file of parameters.');
    }
    expect(compared('{"format":"roverd-parameters","parameters":[1]}', all)).toBe(
      'There are no parameters in the file.',
    );
  });
});
