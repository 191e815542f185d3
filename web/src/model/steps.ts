// Undo that outlives the page: a history of plans as what differs from one to the next, so that a
// mission of 10,000 items with many small edits still fits on the device.

import type { History } from './history';
import type { Home, Item, KeptDrawing, Plan, Settings } from './plan';

/** One plan from another: `gone` items at `at` make room for others. */
export interface Step {
  readonly at: number;
  readonly gone: number;
  readonly items: readonly Item[];
  /** Left out: as before. */
  readonly name?: string;
  readonly home?: Home | null;
  readonly settings?: Settings;
  readonly frame?: { readonly map: string } | null;
  readonly drawing?: KeptDrawing | null;
}
export interface Steps {
  /** The nearest first; each leads from the plan behind it. */
  readonly past: readonly Step[];
  readonly future: readonly Step[];
  /** How many steps back the stored plan lies; negative: ahead; null: in none of them. */
  readonly saved: number | null;
}

/** Items in all the steps that are kept: about half a megabyte of text. */
const KEPT_ITEMS = 5000;
/** What a step weighs besides its items. */
const STEP_ITEMS = 1;

export const step_between = (from: Plan, to: Plan): Step => {
  const shorter = Math.min(from.items.length, to.items.length);
  let at = 0;
  while (at < shorter && from.items[at] === to.items[at]) at += 1;
  let same = 0;
  while (
    same < shorter - at &&
    from.items[from.items.length - 1 - same] === to.items[to.items.length - 1 - same]
  ) {
    same += 1;
  }
  return {
    at,
    gone: from.items.length - same - at,
    items: to.items.slice(at, to.items.length - same),
    ...(from.name === to.name ? {} : { name: to.name }),
    ...(from.home === to.home ? {} : { home: to.home ?? null }),
    ...(from.settings === to.settings ? {} : { settings: to.settings ?? {} }),
    ...(from.frame === to.frame ? {} : { frame: to.frame ?? null }),
    ...(from.drawing === to.drawing ? {} : { drawing: to.drawing ?? null }),
  };
};

/** @return null: the step does not belong to that plan */
export const with_step = (plan: Plan, step: Step): Plan | null => {
  const { at, gone, items, ...members } = step;
  if (at < 0 || gone < 0 || at + gone > plan.items.length) return null;
  return {
    ...plan,
    ...members,
    items: [...plan.items.slice(0, at), ...items, ...plan.items.slice(at + gone)],
  };
};

/** Steps away from the present, as many as there is room for. */
const steps_away = (present: Plan, plans: readonly Plan[], room: { left: number }): Step[] => {
  const steps: Step[] = [];
  let from = present;
  for (const to of plans) {
    const step = step_between(from, to);
    room.left -= step.items.length + STEP_ITEMS;
    if (room.left < 0) break;
    steps.push(step);
    from = to;
  }
  return steps;
};

/** How many steps back a plan lies; negative: ahead; null: it is none of them. */
export const place_in = ({ past, present, future }: History<Plan>, plan: Plan): number | null => {
  if (plan === present) return 0;
  const back = past.lastIndexOf(plan);
  if (back >= 0) return past.length - back;
  const ahead = future.indexOf(plan);
  return ahead >= 0 ? -1 - ahead : null;
};

/** @param place as place_in tells it. @return undefined: the history does not reach there */
export const plan_at = (
  { past, present, future }: History<Plan>,
  place: number,
): Plan | undefined => {
  if (place === 0) return present;
  return place > 0 ? past[past.length - place] : future[-1 - place];
};

/** @param saved the plan as it is stored; null: it never was */
export const steps_of = ({ past, present, future }: History<Plan>, saved: Plan | null): Steps => {
  const room = { left: KEPT_ITEMS };
  const back = [...past].reverse();
  const behind = steps_away(present, back, room);
  const ahead = steps_away(present, future, room);
  const kept: History<Plan> = {
    past: past.slice(past.length - behind.length),
    present,
    future: future.slice(0, ahead.length),
  };
  return { past: behind, future: ahead, saved: saved === null ? null : place_in(kept, saved) };
};

const plans_away = (present: Plan, steps: readonly Step[]): Plan[] => {
  const plans: Plan[] = [];
  let from = present;
  for (const step of steps) {
    const to = with_step(from, step);
    if (to === null) break;
    plans.push(to);
    from = to;
  }
  return plans;
};

export interface Revived {
  readonly history: History<Plan>;
  readonly saved: Plan | null;
}

/** A step that does not fit ends what can be undone; it never spoils the plan. */
export const revived = (present: Plan, { past, future, saved }: Steps): Revived => {
  const back = plans_away(present, past);
  const ahead = plans_away(present, future);
  const history = { past: [...back].reverse(), present, future: ahead };
  return { history, saved: saved === null ? null : (plan_at(history, saved) ?? null) };
};
