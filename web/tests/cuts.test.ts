import { describe, expect, test } from 'vitest';

import { append_waypoint, rename } from '../src/model/actions';
import { cuts_kept, cuts_revived, type Cut } from '../src/model/cuts';
import { draft_text, parse_draft } from '../src/model/draft';
import { begin_history, perform, redo, undo, type History } from '../src/model/history';
import { edits_left, edits_resumed } from '../src/model/past_edits';
import { EMPTY_PLAN, type Plan } from '../src/model/plan';
import { revived, steps_of } from '../src/model/steps';

const STORED = { id: 'a', revision: 3 };
const whole = [1, 2, 3, 4].reduce(
  (history, lat) => perform(history, append_waypoint({ lat, lon: 1 })),
  begin_history<Plan>(EMPTY_PLAN),
);
const first: Plan = { ...whole.present, items: whole.present.items.slice(0, 2) };
const split = perform(whole, () => first);
const cut = (gone = false): Cut => ({ first, name: 'Second', id: 'b', revision: 2, gone });

/** As the page does it: kept as text, read again. */
const reloaded = (history: History<Plan>, cuts: readonly Cut[]) => {
  const { present: plan } = history;
  const steps = steps_of(history, null);
  const kept = cuts_kept(history, cuts);
  const draft = parse_draft(draft_text({ plan, stored: null, unsaved: true, steps, cuts: kept }));
  if (!draft?.steps) throw new Error('no draft');
  const { history: back } = revived(draft.plan, draft.steps);
  return { history: back, cuts: cuts_revived(back, draft.cuts) };
};

describe('a mission that was cut in two, after a reload', () => {
  test('knows the step that joins it again, and which second part goes with it', () => {
    const { history, cuts } = reloaded(split, [cut()]);
    expect(cuts).toEqual([cut()]);
    expect(cuts[0]?.first).toBe(history.present);
    expect(undo(history).present).toEqual(whole.present);
  });

  test('knows it also where more was done since, and where it was taken back', () => {
    const later = reloaded(perform(perform(split, rename('B')), rename('C')), [cut()]);
    expect(later.cuts[0]?.first).toBe(undo(undo(later.history)).present);
    const back = reloaded(undo(split), [cut(true)]);
    expect(back.cuts).toEqual([cut(true)]);
    expect(back.cuts[0]?.first).toBe(redo(back.history).present);
  });

  test('forgets it where no step leads there any more', () => {
    expect(reloaded(perform(undo(split), rename('B')), [cut()]).cuts).toEqual([]);
  });

  test('is as it was, with what is damaged left out', () => {
    const steps = steps_of(split, null);
    const text = draft_text({ plan: first, stored: null, unsaved: true, steps });
    const with_cuts = (cuts: unknown): string =>
      JSON.stringify({ ...(JSON.parse(text) as object), cuts });
    const [kept] = cuts_kept(split, [cut()]);
    expect(parse_draft(with_cuts([1, { ...kept, at: 'x' }, kept]))?.cuts).toEqual([kept]);
    expect(parse_draft(with_cuts('x'))?.cuts).toEqual([]);
    expect(cuts_revived(split, [{ at: 99, name: '', id: '', revision: 1, gone: false }])).toEqual(
      [],
    );
  });
});

describe('a mission that was cut in two, left and opened again', () => {
  test('knows its second part, also where somebody saved it meanwhile', () => {
    const left = edits_left(split, first, STORED, [cut()]);
    if (!left) throw new Error('nothing kept');
    const opened = edits_resumed([left], STORED, { ...first });
    expect(opened.cuts[0]?.first).toBe(opened.history.present);
    const theirs: Plan = { name: 'Theirs', items: [] };
    const changed = edits_resumed([left], { id: 'a', revision: 4 }, theirs);
    expect(changed.cuts[0]?.first).toBe(undo(changed.history).present);
  });
});
