import { describe, expect, it } from 'vitest';

import { append_waypoint, rename } from '../src/model/actions';
import { begin_history, perform, redo, undo } from '../src/model/history';
import { edits_left, edits_resumed, parse_past, with_past } from '../src/model/past_edits';
import type { Plan } from '../src/model/plan';

const STORED = { id: 'a', revision: 3 };
const EMPTY: Plan = { name: 'A', items: [] };

/** One waypoint, saved; then another and another name, not saved. */
const one = perform(begin_history(EMPTY), append_waypoint({ lat: 1, lon: 1 }));
const saved = one.present;
const unsaved = perform(perform(one, append_waypoint({ lat: 2, lon: 2 })), rename('B'));

/** As the page keeps it: left, as text, and read again. */
const past = (history: typeof one, plan: Plan | null = saved) => {
  const kept = edits_left(history, plan, STORED);
  return parse_past(JSON.stringify(kept ? with_past([], kept) : []));
};

describe('a mission to which one comes back', () => {
  it('is as it was left, and its steps can be undone', () => {
    const { history } = edits_resumed(past(one), STORED, saved);
    expect(history.present).toEqual(saved);
    expect(undo(history).present).toEqual(EMPTY);
  });

  it('is as it is stored; what was not saved is one step back', () => {
    const { history } = edits_resumed(past(unsaved), STORED, saved);
    expect(history.present).toEqual(saved);
    expect(undo(history).present).toEqual(unsaved.present);
    expect(undo(undo(undo(history))).present).toEqual(saved);
  });

  it('can still be done again what had been undone', () => {
    const { history } = edits_resumed(past(undo(one), EMPTY), STORED, EMPTY);
    expect(history.present).toEqual(EMPTY);
    expect(redo(history).present).toEqual(saved);
  });

  it('has what somebody else saved meanwhile as one more step', () => {
    const theirs: Plan = { name: 'Theirs', items: [] };
    const { history } = edits_resumed(past(one), { id: 'a', revision: 4 }, theirs);
    expect(history.present).toBe(theirs);
    expect(undo(history).present).toEqual(saved);
  });

  it('begins anew where nothing is kept of it, or nothing was done', () => {
    expect(edits_left(begin_history(saved), saved, STORED)).toBeNull();
    expect(edits_resumed(past(one), { id: 'b', revision: 1 }, EMPTY).history.past).toEqual([]);
    expect(
      edits_resumed([{ id: 'a', draft: '{"version": 1' }], STORED, EMPTY).history.past,
    ).toEqual([]);
  });
});

describe('what is kept of missions that were left', () => {
  const kept = (id: string, letters = 1) => ({ id, draft: 'x'.repeat(letters) });

  it('has each once, the newest first, the oldest without room for them gone', () => {
    const two = with_past(with_past([], kept('a')), kept('b'));
    expect(two.map(({ id }) => id)).toEqual(['b', 'a']);
    expect(with_past(two, kept('a', 2))).toEqual([kept('a', 2), kept('b')]);
    expect(with_past(two, kept('c', 5), 6).map(({ id }) => id)).toEqual(['c', 'b']);
    let many = two;
    for (let k = 0; k < 30; k += 1) many = with_past(many, kept(`${k}`));
    expect(many).toHaveLength(20);
  });

  it('is nothing where it cannot be read', () => {
    expect(parse_past(null)).toEqual([]);
    expect(parse_past('[{"id": 1}, 3')).toEqual([]);
    expect(parse_past('[{"id": 1}, null, {"id": "a", "draft": "t"}]')).toEqual([
      { id: 'a', draft: 't' },
    ]);
    expect(parse_past('{}')).toEqual([]);
  });
});
