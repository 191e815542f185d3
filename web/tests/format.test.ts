import { describe, expect, test } from 'vitest';

import { complaint, refusal_text, refused_items, type Refusal } from '../src/model/answer';
import {
  accuracy,
  age,
  beside,
  clock_time,
  coordinates,
  count,
  direction,
  duration,
  metres,
  number_text,
  offset_words,
  said_in,
} from '../src/model/format';

describe('what was said already', () => {
  const said = ['the position was set anew 5.0 m away: look where the robot stands', ''];

  test('is a part of it, it with more words, or the same in other letters', () => {
    expect(said_in('The position was set anew 5.0 m away', said)).toBe(true);
    expect(said_in(`paused: ${said[0] ?? ''}`, said)).toBe(true);
  });

  test('is not anything else', () => {
    expect(said_in('the battery is low', said)).toBe(false);
    expect(said_in('the battery is low', [])).toBe(false);
  });
});

describe('format', () => {
  test('an unknown value is a dash, never a zero', () => {
    for (const unknown of [null, undefined, Number.NaN]) {
      for (const words of [metres, accuracy, age, duration, direction]) {
        expect(words(unknown)).toBe('—');
      }
      expect(number_text(unknown, 1, 'V')).toBe('—');
    }
    expect(coordinates(null)).toBe('—');
    expect(clock_time('never')).toBe('—');
  });

  test('metres are given in the unit that reads best', () => {
    expect(metres(0)).toBe('0.0 cm');
    expect(metres(0.034)).toBe('3.4 cm');
    expect(metres(-0.02)).toBe('−2.0 cm');
    expect(metres(3.2)).toBe('3.20 m');
    expect(metres(21.44)).toBe('21.4 m');
    expect(metres(640.2)).toBe('640 m');
    expect(metres(1234)).toBe('1.23 km');
    expect(metres(16_909_920)).toBe('16910 km');
  });

  test('a place beside the path has a side, not a sign', () => {
    expect(beside(0.034)).toBe('3.4 cm left');
    expect(beside(-1.5)).toBe('1.50 m right');
    expect(beside(0)).toBe('0.0 cm');
    expect(beside(null)).toBe('—');
  });

  test('zero has no sign', () => {
    expect(number_text(-0.001, 2, 'm/s')).toBe('0.00 m/s');
    expect(number_text(-0.5, 2)).toBe('−0.50');
  });

  test('accuracy never pretends to be perfect', () => {
    expect(accuracy(0.001)).toBe('±1 cm');
    expect(accuracy(0.023)).toBe('±2 cm');
    expect(accuracy(2.54)).toBe('±2.5 m');
    expect(accuracy(12.6)).toBe('±13 m');
  });

  test('ages and durations grow into larger units', () => {
    expect(age(0.04)).toBe('0.0 s');
    expect(age(12.4)).toBe('12 s');
    expect(age(300)).toBe('5 min');
    expect(age(7300)).toBe('2 h');
    expect(duration(45)).toBe('45 s');
    expect(duration(185)).toBe('3 min 05 s');
    expect(duration(4320)).toBe('1 h 12 min');
  });

  test('an offset goes to the side that it goes to', () => {
    expect(offset_words(-13.469, 1.2)).toBe('13.47 m W, 1.20 m N');
    expect(offset_words(0, -0.5)).toBe('0.00 m E, 0.50 m S');
  });

  test('directions have three digits and a wind', () => {
    expect(direction(0)).toBe('000° N');
    expect(direction(359.7)).toBe('000° N');
    expect(direction(48)).toBe('048° NE');
    expect(direction(-90)).toBe('270° W');
  });

  test('one and many', () => {
    expect(count(1, 'item')).toBe('1 item');
    expect(count(0, 'item')).toBe('0 items');
  });
});

describe('refusals', () => {
  const refusal: Refusal = {
    status: 422,
    title: 'Invalid',
    detail: 'Two values are not valid.',
    errors: [
      { pointer: '/items/3/lat', detail: 'must be from -90 to 90' },
      { pointer: '/items/12', detail: 'is empty' },
      { pointer: '/name', detail: 'is empty' },
    ],
  };

  test('name every cause', () => {
    expect(refusal_text(refusal)).toContain('Two values are not valid.');
    expect(refusal_text(refusal)).toContain('item 4, lat: must be from -90 to 90');
    expect(refusal_text({ ...refusal, detail: '', errors: [] })).toBe('Invalid');
  });

  test('say nothing twice', () => {
    const errors = [{ pointer: '', detail: 'line 3: no number' }];
    const said = { ...refusal, detail: 'rows.csv, line 3: no number', errors };
    expect(refusal_text(said)).toBe('rows.csv, line 3: no number');
  });

  test('names fields in words, and leaves the paths of the interface', () => {
    const crosses: Refusal = {
      status: 422,
      title: 'Invalid',
      detail: '/areas/0/polygon crosses or touches itself: POST /vehicle/estop still stops',
      errors: [{ pointer: '/areas/0/polygon', detail: 'crosses or touches itself' }],
    };
    expect(refusal_text(crosses)).toBe(
      'area 1 crosses or touches itself: POST /vehicle/estop still stops',
    );
    const short = 'must have at least 12 characters';
    const password: Refusal = {
      ...crosses,
      detail: `/password ${short}`,
      errors: [{ pointer: '/password', detail: short }],
    };
    expect(complaint(password)).toBe(`password ${short}`);
  });

  test('point at the items they are about', () => {
    expect([...refused_items(refusal)]).toEqual([3, 12]);
  });
});
