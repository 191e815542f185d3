// What the editor is given, and what others ask of a mission to edit it.

import type { Plan } from '../model/plan';
import type { DraftStorage, Mission } from '../model/ports';

export const plan_of = (mission: Mission): Plan => ({
  name: mission.name,
  items: mission.items,
  home: mission.home,
  settings: mission.settings,
  ...(mission.drawing ? { drawing: mission.drawing } : {}),
});

/** What is shown in place of the plan before it is done. */
export interface Preview {
  readonly open: boolean;
  cancel(): void;
}

/** On the device: what is edited, what can be undone in missions edited before, and of what they were
 * made. */
export interface Kept {
  readonly draft: DraftStorage;
  readonly past: DraftStorage;
  readonly makings: DraftStorage;
}
