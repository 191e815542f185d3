import { describe, expect, it } from 'vitest';

import { same_words } from '../src/model/words';

describe('same words', () => {
  const state = { time: '12:00', armed: true, speed: 0.5, mission: { state: 'running', off: 0.1 } };

  it('lets figures differ', () => {
    expect(same_words(state, { ...state, speed: 0.7, mission: { state: 'running', off: 2 } })).toBe(
      true,
    );
  });

  it('tells a word, a yes or no, or a figure that is gone', () => {
    expect(same_words(state, { ...state, armed: false })).toBe(false);
    expect(same_words(state, { ...state, mission: { state: 'paused', off: 0.1 } })).toBe(false);
    expect(same_words(state, { ...state, speed: null })).toBe(false);
    expect(same_words({ ...state, mission: null }, state)).toBe(false);
  });

  it('tells what came or went', () => {
    expect(same_words({ safety: [] }, { safety: [{ kind: 'bumper' }] })).toBe(false);
    expect(same_words({ safety: ['a', 'b'] }, { safety: ['a'] })).toBe(false);
    expect(same_words({ at: 1 }, { at: 1, goal: 2 })).toBe(false);
    expect(same_words({ at: 1 }, { to: 1 })).toBe(false);
  });

  it('leaves out what does not count, at the top only', () => {
    expect(same_words(state, { ...state, time: '12:01' })).toBe(false);
    expect(same_words(state, { ...state, time: '12:01' }, ['time'])).toBe(true);
    expect(same_words({ in: { time: 'a' } }, { in: { time: 'b' } }, ['time'])).toBe(false);
  });
});
