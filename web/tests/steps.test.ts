import { describe, expect, test } from 'vitest';

import {
  append_waypoint,
  move_waypoint,
  remove_item,
  rename,
  reverse_items,
} from '../src/model/actions';
import { draft_text, parse_draft } from '../src/model/draft';
import { begin_history, perform, redo, undo } from '../src/model/history';
import { EMPTY_PLAN, type Plan } from '../src/model/plan';
import { revived, step_between, steps_of, with_step } from '../src/model/steps';

const drawn = (): ReturnType<typeof begin_history<Plan>> => {
  let history = begin_history<Plan>(EMPTY_PLAN);
  for (let k = 0; k < 4; k += 1) history = perform(history, append_waypoint({ lat: k, lon: 1 }));
  history = perform(history, move_waypoint(1, { lat: 9, lon: 9 }));
  history = perform(history, rename('Field'));
  history = perform(history, remove_item(0));
  return perform(history, reverse_items);
};

/** As the page does it: kept as text, read again. */
const reloaded = (history: ReturnType<typeof drawn>, saved: Plan | null) => {
  const steps = steps_of(history, saved);
  const text = draft_text({ plan: history.present, stored: null, unsaved: true, steps });
  const draft = parse_draft(text);
  if (!draft?.steps) throw new Error('no draft');
  return revived(draft.plan, draft.steps);
};

describe('a history', () => {
  test('is undone and redone after a reload as before', () => {
    const before = undo(undo(drawn()));
    const { history } = reloaded(before, null);
    const walk = (of: typeof before): Plan[] => {
      const plans: Plan[] = [];
      let at = of;
      while (at.past.length > 0) at = undo(at);
      for (;;) {
        plans.push(at.present);
        if (at.future.length === 0) return plans;
        at = redo(at);
      }
    };
    expect(walk(history)).toEqual(walk(before));
    expect(walk(history)).toHaveLength(9);
  });

  test('still knows which of its plans is stored', () => {
    const all = drawn();
    const saved = undo(undo(all)).present;
    expect(reloaded(all, saved).saved).toEqual(saved);
    const back = undo(undo(undo(all)));
    const { history, saved: ahead } = reloaded(back, saved);
    expect(redo(history).present).toBe(ahead);
    expect(reloaded(all, EMPTY_PLAN).saved).toEqual(EMPTY_PLAN);
    expect(reloaded(all, { ...EMPTY_PLAN }).saved).toBeNull();
  });

  test('of a large mission keeps its small edits, and only as much of large ones as there is room', () => {
    const items = Array.from({ length: 10_000 }, (_, k) => ({
      type: 'waypoint' as const,
      lat: k / 1000,
      lon: 2,
    }));
    let history = begin_history<Plan>({ name: 'Large', items });
    for (let k = 0; k < 50; k += 1)
      history = perform(history, move_waypoint(k, { lat: 1, lon: 1 }));
    expect(steps_of(history, null).past).toHaveLength(50);
    expect(JSON.stringify(steps_of(history, null)).length).toBeLessThan(10_000);
    history = perform(history, reverse_items);
    expect(steps_of(history, null).past).toHaveLength(0);
  });
});

test('a step that does not belong to the plan is refused', () => {
  const [a, b] = [drawn().present, EMPTY_PLAN];
  expect(with_step(a, step_between(a, b))).toMatchObject({ items: [], name: b.name });
  expect(with_step(b, { at: 0, gone: 1, items: [] })).toBeNull();
});

test('steps that are damaged are left out, the draft is not', () => {
  const history = drawn();
  const draft = { plan: history.present, stored: null, unsaved: true };
  const good = draft_text({ ...draft, steps: steps_of(history, null) });
  const bad = good.replace('"gone":', '"gon":');
  expect(parse_draft(bad)?.plan).toEqual(history.present);
  expect(parse_draft(bad)?.steps).toBeUndefined();
});
