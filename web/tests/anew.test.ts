import { describe, expect, it } from 'vitest';

import { try_limit_ms } from '../src/model/anew';

const limits = (back_ms: number): (number | undefined)[] =>
  [0, 1, 2, 3].map((tries) => try_limit_ms(tries, back_ms));

describe('what only reads, over a link that was lost', () => {
  it('is asked soon again over every dead connection, and has all its time in the end', () => {
    expect(limits(0)).toEqual([800, 800, 800, undefined]);
    expect(limits(9_900)).toEqual([800, 800, 800, undefined]);
  });

  it('is asked once where nothing was lost, or long ago', () => {
    expect(limits(Infinity)).toEqual([undefined, undefined, undefined, undefined]);
    expect(limits(10_000)).toEqual([undefined, undefined, undefined, undefined]);
  });
});
