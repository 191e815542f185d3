// A first save over a link that loses answers.

import { describe, expect, test } from 'vitest';

import { EMPTY_PLAN, type Plan } from '../src/model/plan';
import type { Answer, Refusal } from '../src/model/answer';
import type { Mission, MissionCalls } from '../src/model/ports';
import { FirstSave } from '../src/model/first_save';

const named = (name: string): Plan => ({ ...EMPTY_PLAN, name });
const refused = (status: number): Answer<Mission> => ({
  ok: false,
  refusal: { status, title: '', detail: '', errors: [] } satisfies Refusal,
});

/** A robot that stores what it is given once for each key; each answer may be lost, or be another. */
const robot = (answers: readonly (Answer<Mission> | null)[] = []) => {
  const stored = new Map<string, Plan>();
  const left = [...answers];
  const answer = (key: string, plan: Plan): Answer<Mission> => {
    const other = left.shift();
    const made = { id: key, revision: 1, ...plan } as unknown as Mission;
    return other ?? { ok: true, value: made };
  };
  const calls = {
    create: (plan: Plan, key = '') => {
      if (!stored.has(key)) stored.set(key, plan);
      return Promise.resolve(answer(key, plan));
    },
    replace: (id: string, _: number, plan: Plan) => {
      const said = answer(id, plan);
      if (said.ok) stored.set(id, plan);
      return Promise.resolve(said);
    },
  } as unknown as MissionCalls;
  const names = (): string[] => [...stored.values()].map(({ name }) => name);
  let keys = 0;
  return { first: new FirstSave(calls, () => `key ${keys++}`), names };
};
const keep = (): void => undefined;

describe('a first save', () => {
  test('is the same one when it is pressed again, also with what was changed since', async () => {
    const { first, names } = robot([refused(0)]);
    expect((await first.create(named('A'), keep)).ok).toBe(false);
    expect(first.tried?.plan.name).toBe('A');
    expect((await first.create(named('B'), keep)).ok).toBe(true);
    expect(names()).toEqual(['B']);
    expect(first.tried).toBeNull();
  });

  test('is still open while what was changed since did not arrive', async () => {
    const { first, names } = robot([refused(0), null, refused(0)]);
    await first.create(named('A'), keep);
    expect((await first.create(named('B'), keep)).ok).toBe(false);
    expect((await first.create(named('C'), keep)).ok).toBe(true);
    expect(names()).toEqual(['C']);
  });

  test('that was refused is over, and the next one another', async () => {
    const { first } = robot([refused(422)]);
    await first.create(named('A'), keep);
    expect(first.tried).toBeNull();
  });

  test('that somebody else changed meanwhile stays his, and this is one of its own', async () => {
    const { first, names } = robot([refused(0), null, refused(412)]);
    await first.create(named('A'), keep);
    expect((await first.create(named('B'), keep)).ok).toBe(true);
    expect(names()).toEqual(['A', 'B']);
  });
});
