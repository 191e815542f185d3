import { describe, expect, it } from 'vitest';

import { invitation_in, is_pin, pressed, roles_below } from '../src/model/access';

describe('PIN', () => {
  it('grows by digits up to eight and shrinks by the key for it', () => {
    const keys = ['2', '5', 'x', '8', 'back', '8', '0', '', '12'];
    expect(keys.reduce(pressed, '')).toBe('2580');
    expect(pressed('', 'back')).toBe('');
    expect(pressed('12345678', '9')).toBe('12345678');
  });

  it('is four to eight digits', () => {
    expect(['2580', '12345678'].every(is_pin)).toBe(true);
    expect(['', '258', '123456789', '25 80', '２５８０'].some(is_pin)).toBe(false);
  });
});

describe('invitation', () => {
  it('is read from behind the #, and nothing else is', () => {
    expect(invitation_in('#invite=KTRF-3M7X')).toBe('KTRF-3M7X');
    expect(invitation_in('#invite=ktrf3m7x')).toBe('ktrf3m7x');
    for (const text of ['', '#', '#invite=', '#sha256=ab', '#invite=<script>', '?invite=KTRF-3M7X'])
      expect(invitation_in(text)).toBeNull();
  });

  it('gives no more than the inviter may', () => {
    expect(roles_below('operator')).toEqual(['viewer', 'operator']);
    expect(roles_below('admin')).toHaveLength(3);
    expect(roles_below('')).toEqual([]);
  });
});
