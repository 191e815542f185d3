// What can be done with the chosen items: one table makes the buttons, the fields and the preview,
// and says why one of them makes no sense now.

import type { PlanAction } from './actions';
import type { Plan } from './plan';
import { type PlainKey, say } from './say';
import { picked_spots, type Picked } from './selection';
import {
  align_items,
  mirror_items,
  move_items,
  parallel_items,
  rotate_items,
  scale_items,
} from './shapes';
import { densify_items, reverse_stretch, simplify_items } from './stretch';

export interface Amount {
  readonly key: string;
  readonly label: PlainKey;
  readonly unit: string;
  /** What can be typed. */
  readonly min: number;
  readonly max: number;
  /** Of the slider and the buttons beside it, while nothing else was typed. */
  readonly reach: readonly [least: number, most: number];
  readonly step: number;
  readonly begin: number;
}
type Amounts = Readonly<Record<string, number>>;

export interface Transform {
  readonly key: string;
  readonly label: PlainKey;
  readonly amounts: readonly Amount[];
  /** Places that must be chosen at least. */
  readonly least: number;
  readonly action: (picked: Picked, amounts: Amounts) => PlanAction;
}

const amount = (
  [key, label, unit]: readonly [string, PlainKey, string],
  [min, max]: readonly [number, number],
  reach: readonly [number, number],
  step: number,
  begin: number,
): Amount => ({ key, label, unit, min, max, reach, step, begin });

const metres = (key: string, label: PlainKey): Amount =>
  amount([key, label, 'm'], [-10_000, 10_000], [-20, 20], 0.1, 0);

const value = (amounts: Amounts, key: string): number => amounts[key] ?? 0;

export const TRANSFORMS: readonly Transform[] = [
  {
    key: 'move',
    label: 'move',
    amounts: [metres('east', 'east'), metres('north', 'north')],
    least: 1,
    action: (picked, by) =>
      move_items(picked, { east_m: value(by, 'east'), north_m: value(by, 'north') }),
  },
  {
    key: 'rotate',
    label: 'rotate',
    amounts: [amount(['deg', 'clockwise', '°'], [-360, 360], [-180, 180], 1, 0)],
    least: 2,
    action: (picked, by) => rotate_items(picked, value(by, 'deg'), null),
  },
  {
    key: 'scale',
    label: 'scale',
    amounts: [amount(['percent', 'size', '%'], [1, 10_000], [10, 300], 1, 100)],
    least: 2,
    action: (picked, by) => scale_items(picked, value(by, 'percent') / 100, null),
  },
  {
    key: 'mirror',
    label: 'mirror',
    amounts: [amount(['deg', 'axis_direction', '°'], [0, 360], [0, 180], 1, 0)],
    least: 2,
    action: (picked, by) => mirror_items(picked, value(by, 'deg'), null),
  },
  {
    key: 'beside',
    label: 'offset',
    amounts: [metres('right', 'to_the_right_2')],
    least: 2,
    action: (picked, by) => parallel_items(picked, value(by, 'right')),
  },
  {
    key: 'align',
    label: 'straighten',
    amounts: [],
    least: 3,
    action: (picked) => align_items(picked),
  },
  {
    key: 'reverse',
    label: 'reverse',
    amounts: [],
    least: 2,
    action: (picked) => reverse_stretch(picked),
  },
  {
    key: 'simplify',
    label: 'simplify',
    amounts: [amount(['m', 'may_be_off_by', 'm'], [0.001, 1000], [0.01, 2], 0.01, 0.05)],
    least: 3,
    action: (picked, by) => simplify_items(picked, value(by, 'm')),
  },
  {
    key: 'densify',
    label: 'densify',
    amounts: [amount(['m', 'at_most_apart', 'm'], [0.05, 1000], [0.5, 20], 0.5, 5)],
    least: 2,
    action: (picked, by) => densify_items(picked, value(by, 'm')),
  },
];

export const first_amounts = (transform: Transform): Amounts =>
  Object.fromEntries(transform.amounts.map(({ key, begin }) => [key, begin]));

/** One step more or less, within what may be typed. @param by 1 or −1 */
export const stepped = ({ min, max, step }: Amount, from: number, by: number): number => {
  const next = Math.round((from + by * step) * 1e6) / 1e6;
  return Math.min(max, Math.max(min, next));
};

/** Why it makes no sense for these; null: it does. */
export const why_not_transform = (
  transform: Transform,
  plan: Plan,
  picked: Picked,
): string | null => {
  const missing = transform.least - picked_spots(plan, picked).length;
  if (missing > 0) {
    return say('more_points_needed', { n: missing });
  }
  const local = [...picked].some((index) => plan.items[index]?.type === 'local');
  return local && transform.key !== 'reverse' ? say('a_local_point_is_measured_from_home') : null;
};

/** A mission is kept with so many. */
export const ITEMS_MOST = 200_000;

/** Why the result cannot be taken; null: it can. */
export const why_not_apply = (before: Plan, after: Plan): string | null => {
  if (after === before) return say('this_changes_nothing');
  return after.items.length > ITEMS_MOST
    ? say('that_would_be_items_items_too_many', { items: after.items.length })
    : null;
};
