import { describe, expect, it } from 'vitest';

import type { Refusal } from '../src/model/answer';
import { rest_question } from '../src/model/import_rest';

const refusal = (lines: number): Refusal => ({
  status: 422,
  title: 'Invalid values',
  detail: 'the file has wrong values',
  errors: Array.from({ length: lines }, (_, k) => ({
    pointer: k === 0 ? '/features/4' : `line ${k}`,
    detail: 'latitude must be from -90 to 90, is 95',
  })),
  rest: { taken: 40, changed: 2, left_out: lines },
});

describe('the question whether the rest of a file is taken', () => {
  it('names where and what is wrong, and how much is left', () => {
    const { text } = rest_question('field.kml', refusal(2));
    expect(text).toContain('“field.kml”');
    expect(text).toContain('feature 5: latitude must be from -90 to 90, is 95');
    expect(text).toContain('line 1: latitude');
    expect(text).toContain('(42)');
    expect(text).toContain('(2)');
  });

  it('names a few of many', () => {
    const { text } = rest_question('field.kml', refusal(9));
    expect(text).toContain('line 2: ');
    expect(text).not.toContain('line 3: ');
    expect(text).toContain('and 6 more');
  });
});
