import { describe, expect, it } from 'vitest';

import {
  age_words,
  choice_of,
  chosen,
  FIRST_PACE,
  is_frozen,
  next_pace,
  taken_ms,
  type Pace,
} from '../src/model/camera';

const cameras = ['front', 'back'].map((name) => ({ name, state: 'up', reason: null }));

describe('the age of a picture', () => {
  it('counts from when it was taken, the way of the asking included', () => {
    const taken = taken_ms(10_000, { picture: null, count: 3, age_ms: 120 });
    expect(age_words(taken, 10_080)).toBe('0.2 s');
  });
  it('goes on where nothing comes any more, and says that it is frozen', () => {
    expect(is_frozen(5000, 6000)).toBe(false);
    expect(is_frozen(5000, 6001)).toBe(true);
    expect(age_words(5000, 8240)).toBe('Frozen 3.2 s');
    expect(age_words(0, 140_000)).toBe('Frozen 140 s');
  });
  it('is told as missing before the first one', () => {
    expect(is_frozen(null, 0)).toBe(true);
    expect(age_words(null, 0)).toBe('No picture yet');
  });
});

describe('the size that is wished', () => {
  const after = (pace: Pace, ...took_ms: number[]): Pace => took_ms.reduce(next_pace, pace);
  it('is less where one took long, down to an eighth', () => {
    expect(after(FIRST_PACE, 501).divisor).toBe(2);
    expect(after(FIRST_PACE, 900, 900, 900, 900).divisor).toBe(8);
  });
  it('is more again only after forty quick ones in a row', () => {
    const quick = (n: number): number[] => Array.from({ length: n }, () => 60);
    expect(after({ divisor: 4, quick: 0 }, ...quick(39)).divisor).toBe(4);
    expect(after({ divisor: 4, quick: 0 }, ...quick(40)).divisor).toBe(2);
    expect(after({ divisor: 4, quick: 0 }, ...quick(39), 200, ...quick(39)).divisor).toBe(4);
  });
});

describe('the choice', () => {
  it('is kept, and anything else that was written is as at first', () => {
    expect(choice_of('{"on":false,"name":"back"}')).toEqual({ on: false, name: 'back' });
    for (const text of [null, '', '7', '[]', '{"on":"no","name":3}']) {
      expect(choice_of(text)).toEqual({ on: true, name: null });
    }
  });
  it('is the first camera where the chosen one is not there', () => {
    expect(chosen(cameras, 'back')?.name).toBe('back');
    expect(chosen(cameras, 'gone')?.name).toBe('front');
    expect(chosen([], 'front')).toBeNull();
  });
});
