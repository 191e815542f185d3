// A mission on its way between the robot and the page: the plan in it, and what is sent back.

import type { Plan } from './plan';
import type { Mission } from './ports';

/** All that is edited of a mission: what is left out here is lost when it is saved. */
export const plan_of = (mission: Mission): Plan => ({
  name: mission.name,
  items: mission.items,
  home: mission.home,
  settings: mission.settings,
  ...(mission.frame ? { frame: mission.frame } : {}),
  ...(mission.drawing ? { drawing: mission.drawing } : {}),
});

/** What a mission is stored by; the robot numbers and dates it. */
export const body_of = (plan: Plan) => ({
  name: plan.name,
  items: [...plan.items],
  home: plan.home ?? null,
  settings: plan.settings ?? {},
  ...(plan.frame ? { frame: plan.frame } : {}),
  ...(plan.drawing ? { drawing: plan.drawing } : {}),
});

/** Without what says nothing: the robot leaves it out. */
const said = (value: unknown): unknown => {
  if (Array.isArray(value)) return value.map(said);
  if (typeof value !== 'object' || value === null) return value;
  return Object.fromEntries(
    Object.entries(value)
      .filter(([, each]) => each !== null && each !== undefined && each !== false)
      .sort(([a], [b]) => (a < b ? -1 : 1))
      .map(([name, each]) => [name, said(each)]),
  );
};

const same = (a: unknown, b: unknown): boolean =>
  JSON.stringify(said(a)) === JSON.stringify(said(b));

/** @param stored by the robot, which fills in the settings that were left out */
export const same_plan = (plan: Plan, stored: Plan): boolean => {
  const { settings, ...rest } = body_of(plan);
  const { settings: theirs, ...all } = body_of(stored);
  return same(rest, all) && same({ ...theirs, ...settings }, theirs);
};
