// What the editor is given.

import type { DraftStorage } from '../model/ports';

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
