import { expect, test } from 'vitest';

import { differences, differences_words, other_on_map } from '../src/model/compare';
import type { Item, Plan } from '../src/model/plan';

const at = (lat: number, more: object = {}): Item =>
  ({ type: 'waypoint', lat, lon: 1, ...more }) as Item;
const plan = (...items: Item[]): Plan => ({ name: 'P', items });

test('a point that was moved is gone where it was and there where it is', () => {
  const [mine, theirs] = [plan(at(1), at(2), at(3)), plan(at(1), at(5), at(3), at(4))];
  const { added, gone, reordered } = differences(mine, theirs);
  expect([added, gone, reordered]).toEqual([[at(5), at(4)], [at(2)], false]);
  const [line, lost, more] = other_on_map(mine, theirs, 'theirs');
  expect(line).toMatchObject({ tone: 'theirs', places: [{ lat: 1 }, { lat: 5 }, {}, {}] });
  expect(lost?.places).toEqual([{ lat: 2, lon: 1 }]);
  expect(more).toMatchObject({ tone: 'added', points: 'ring', places: [{ lat: 5 }, { lat: 4 }] });
});

test('fields in another order, and fields that say nothing, are no difference', () => {
  const one = plan({ type: 'waypoint', lat: 1, lon: 2, speed_mps: null });
  const other = plan({ lon: 2, lat: 1, type: 'waypoint' } as Item);
  expect(differences_words(differences(one, other))).toBe('nothing differs');
  const said: Plan = { ...other, home: null, settings: { at_end: 'hold' } };
  expect(differences_words(differences(one, said))).toBe('nothing differs');
});

test('it is said in a sentence', () => {
  const words = (a: Plan, b: Plan): string => differences_words(differences(a, b));
  expect(words(plan(at(1), at(1)), plan(at(1)))).toBe('1 item fewer');
  expect(words(plan(at(1), at(2)), plan(at(2), at(1)))).toBe('another order');
  expect(words(plan(), { ...plan(), name: 'Q', settings: { speed_mps: 1 } })).toBe(
    'another name, other settings',
  );
});
