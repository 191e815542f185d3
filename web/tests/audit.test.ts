import { describe, expect, it } from 'vitest';

import {
  ANY_DEED,
  check_words,
  deed_query,
  deed_words,
  doer,
  export_parts,
  result_words,
  type Deed,
} from '../src/model/audit';

const deed: Deed = {
  id: 7,
  time: null,
  user: 'anna',
  credential: null,
  address: '10.0.0.2',
  call: 'POST /missions',
  target: '/missions',
  status: 201,
  detail: null,
  times: 1,
};

describe('a search for who did what', () => {
  it('asks for nothing where nothing is typed', () => {
    expect(deed_query(ANY_DEED)).toEqual({});
    expect(deed_query({ ...ANY_DEED, user: '  ', from: 'soon' })).toEqual({});
  });
  it('asks for what is typed, with times as the robot reads them', () => {
    const query = deed_query({
      user: ' anna ',
      address: '::1',
      call: '/missions',
      result: 'refused',
      from: '2026-03-01T12:00Z',
      to: '2026-03-02T12:00Z',
    });
    expect(query).toEqual({
      user: 'anna',
      address: '::1',
      call: '/missions',
      refused: 'true',
      from: '2026-03-01T12:00:00.000Z',
      to: '2026-03-02T12:00:00.000Z',
    });
    expect(deed_query({ ...ANY_DEED, result: 'done' })).toEqual({ refused: 'false' });
  });
});

describe('a deed', () => {
  it('is told with whoever did it, or from where', () => {
    expect(doer(deed)).toBe('anna');
    expect(doer({ ...deed, user: null })).toBe('10.0.0.2');
    expect(doer({ ...deed, user: null, address: null })).toBe('nobody known');
  });
  it('names what it was done to', () => {
    const gone = { ...deed, call: 'DELETE /missions/{id}', target: '/api/v1/missions/k7' };
    expect(deed_words(gone)).toBe('DELETE /missions/k7');
    expect(deed_words({ ...deed, call: 'CONTROL taken', target: null })).toBe('CONTROL taken');
    expect(deed_words({ ...deed, call: 'GET (unknown)', target: '/etc' })).toBe('GET (unknown)');
  });
  it('ends in words', () => {
    const words = [101, 200, 401, 403, 409, 429, 503].map(result_words);
    expect(words).toEqual([
      'done',
      'done',
      'not logged in',
      'not allowed',
      'refused',
      'too often',
      'failed',
    ]);
  });
});

describe('the chain', () => {
  const whole = { whole: true, rows: 45_000, first: 101, last: 45_100, broken_at: null };
  it('says whether it is as it was written', () => {
    expect(check_words(whole)).toContain('rows 101 to 45100');
    expect(check_words({ ...whole, whole: false, broken_at: 400 })).toContain('row 400');
    expect(check_words({ ...whole, rows: 0, first: null, last: null })).toContain('Nothing');
  });
  it('is taken away in files that hold every row once', () => {
    expect(export_parts(whole)).toEqual([
      { after: 100, label: 'Export rows 101 to 20100' },
      { after: 20_100, label: 'Export rows 20101 to 40100' },
      { after: 40_100, label: 'Export rows 40101 to 45100' },
    ]);
    expect(export_parts({ ...whole, first: null, last: null })).toEqual([]);
  });
});
