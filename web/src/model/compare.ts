// What differs between two states of a mission, for the eye: on the map, and in a sentence. An item
// that was changed is gone as it was and there as it is.

import { line_of } from './beside';
import { count } from './format';
import type { BesideTone, LineOnMap } from './on_map';
import { place_of, type Item, type LatLon, type Plan } from './plan';
import { say } from './say';

export interface Differences {
  /** In the second state and not in the first. */
  readonly added: readonly Item[];
  readonly gone: readonly Item[];
  /** The same items, in another order. */
  readonly reordered: boolean;
  readonly renamed: boolean;
  readonly otherwise_set: boolean;
}

/** Fields in one order, and those that say nothing left out. */
export const words_of = (item: object): string =>
  JSON.stringify(
    Object.entries(item)
      .filter(([, value]) => value !== null && value !== undefined)
      .sort(([a], [b]) => (a < b ? -1 : 1)),
  );

/** What is in the first list more often than in the second. */
const surplus = (items: readonly Item[], others: readonly Item[]): Item[] => {
  const known = new Map<string, number>();
  for (const item of others) {
    const words = words_of(item);
    known.set(words, (known.get(words) ?? 0) + 1);
  }
  return items.filter((item) => {
    const words = words_of(item);
    const left = known.get(words) ?? 0;
    if (left > 0) known.set(words, left - 1);
    return left === 0;
  });
};

export const differences = (from: Plan, to: Plan): Differences => {
  const gone = surplus(from.items, to.items);
  const added = surplus(to.items, from.items);
  const same = gone.length === 0 && added.length === 0;
  // What is left out is as if it were said.
  const settings = ({ settings: set, home, frame }: Plan): string =>
    words_of({ at_end: 'hold', ...set, home: home && words_of(home), frame: frame?.map });
  return {
    added,
    gone,
    reordered:
      same &&
      to.items.some((item, k) => words_of(item) !== words_of(from.items[k] ?? { none: true })),
    renamed: from.name !== to.name,
    otherwise_set: settings(from) !== settings(to),
  };
};

export const differences_words = (of: Differences): string => {
  // A point that was moved is gone as it was, and there as it is.
  const other = Math.min(of.added.length, of.gone.length);
  const [more, fewer] = [of.added.length - other, of.gone.length - other];
  const parts = [
    other > 0 ? say('other_otherwise', { other: count(other, 'item') }) : '',
    more > 0 ? say('more_more', { more: count(more, 'item') }) : '',
    fewer > 0 ? say('fewer_fewer', { fewer: count(fewer, 'item') }) : '',
    of.reordered ? say('another_order') : '',
    of.renamed ? say('another_name') : '',
    of.otherwise_set ? say('other_settings') : '',
  ].filter((part) => part !== '');
  return parts.length === 0 ? say('nothing_differs') : parts.join(', ');
};

const places = (items: readonly Item[]): LatLon[] => items.flatMap((item) => place_of(item) ?? []);

/** The other state dashed; around what only it has one ring, around what it lacks another. */
export const other_on_map = (mine: Plan, other: Plan, tone: BesideTone): readonly LineOnMap[] => {
  const { added, gone } = differences(mine, other);
  return [
    ...line_of(other, tone),
    { places: places(gone), tone: 'gone', points: 'ring' },
    { places: places(added), tone: 'added', points: 'ring' },
  ];
};
