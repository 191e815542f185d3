// Missions that were cut in two, and which step of what can be undone joins them again: kept with the draft,
// so that a step back after a reload still takes the second part back.

import { is_record } from './checked';
import type { History } from './history';
import type { Plan } from './plan';
import { place_in, plan_at } from './steps';

export interface Cut {
  /** What stayed, as it stands in the history. */
  first: Plan;
  /** Of the second part, which is stored. */
  readonly name: string;
  readonly id: string;
  revision: number;
  /** Taken back. */
  gone: boolean;
}

/** As the device keeps it. */
export interface KeptCut {
  /** Where what stayed stands in the history (place_in). */
  readonly at: number;
  readonly name: string;
  readonly id: string;
  readonly revision: number;
  readonly gone: boolean;
}

/** Those that can still be stepped over. */
export const cuts_kept = (history: History<Plan>, cuts: readonly Cut[]): readonly KeptCut[] =>
  cuts.flatMap(({ first, ...cut }) => {
    const at = place_in(history, first);
    return at === null ? [] : [{ at, ...cut }];
  });

/** @param history as it was kept, and read again */
export const cuts_revived = (
  history: History<Plan>,
  kept: readonly KeptCut[] = [],
): readonly Cut[] =>
  kept.flatMap(({ at, name, id, revision, gone }) => {
    const first = plan_at(history, at);
    return first ? [{ first, name, id, revision, gone }] : [];
  });

const is_kept_cut = (value: unknown): value is KeptCut =>
  is_record(value) &&
  Number.isInteger(value['at']) &&
  typeof value['name'] === 'string' &&
  typeof value['id'] === 'string' &&
  Number.isInteger(value['revision']) &&
  typeof value['gone'] === 'boolean';

/** @return what is whole of it */
export const checked_cuts = (value: unknown): readonly KeptCut[] =>
  Array.isArray(value) ? value.filter(is_kept_cut) : [];
