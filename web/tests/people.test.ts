import { expect, test } from 'vitest';

import { token_draft, token_words, type Token } from '../src/model/people';

test('a token for a script that reads may nothing else, and ends by the robot’s clock', () => {
  const now_ms = Date.parse('2026-05-01T10:00:00Z');
  expect(token_draft('  rain gauge ', 'viewer', true, 7, now_ms)).toEqual({
    name: 'rain gauge',
    role: 'viewer',
    methods: ['GET'],
    expires: '2026-05-08T10:00:00.000Z',
  });
});

test('a token without an end says none, and empty methods are all', () => {
  expect(token_draft('plough', 'operator', false, null, 0)).toEqual({
    name: 'plough',
    role: 'operator',
    methods: [],
  });
});

test('a token is told in words that an admin can judge', () => {
  const token: Token = {
    id: 'a',
    name: 'x',
    user: 'anna',
    role: 'operator',
    methods: ['GET'],
    expires: null,
    used: null,
  };
  const write = (stamp: string): string => stamp.slice(0, 10);
  expect(token_words(token, write)).toBe('operator, reads only, without end');
  expect(
    token_words({ ...token, methods: ['GET', 'PUT'], expires: '2026-05-01T10:00:00Z' }, write),
  ).toBe('operator, GET, PUT, until 2026-05-01');
  expect(token_words({ ...token, methods: [] }, write)).toBe('operator, without end');
});
