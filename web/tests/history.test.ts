import { describe, expect, test } from 'vitest';

import { begin_history, HISTORY_LIMIT, perform, redo, undo } from '../src/model/history';

const add = (n: number) => (list: readonly number[]) => [...list, n];

describe('history', () => {
  test('goes back to the very same documents, and forward again', () => {
    const empty: readonly number[] = [];
    const one = perform(begin_history(empty), add(1));
    const two = perform(one, add(2));
    expect(undo(two).present).toBe(one.present);
    expect(undo(undo(two)).present).toBe(empty);
    expect(redo(undo(two)).present).toBe(two.present);
    expect(redo(redo(undo(undo(two)))).present).toEqual([1, 2]);
  });

  test('stays where it is when there is nothing to undo or redo', () => {
    const begin = begin_history([0]);
    expect(undo(begin)).toBe(begin);
    expect(redo(begin)).toBe(begin);
  });

  test('leaves no step behind for an action that changes nothing', () => {
    const begin = begin_history([0]);
    expect(perform(begin, (same) => same)).toBe(begin);
  });

  test('forgets the future when something else is done', () => {
    const two = perform(perform(begin_history<readonly number[]>([]), add(1)), add(2));
    const other = perform(undo(two), add(3));
    expect(other.present).toEqual([1, 3]);
    expect(redo(other)).toBe(other);
  });

  test('forgets the oldest step first', () => {
    let history = begin_history<readonly number[]>([]);
    for (let n = 0; n < HISTORY_LIMIT + 5; n += 1) history = perform(history, () => [n]);
    expect(history.past).toHaveLength(HISTORY_LIMIT);
    expect(history.past[0]).toEqual([4]);
  });
});
