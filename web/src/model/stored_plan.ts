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
