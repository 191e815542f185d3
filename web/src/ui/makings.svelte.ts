// What missions were made of: as the robot keeps it, else as this device does.

import {
  drawing_in,
  making_of,
  mark_of,
  parse_makings,
  with_making,
  type Drawn,
  type Found,
  type Making,
} from '../model/makings';
import type { Item } from '../model/plan';
import type { DraftStorage } from '../model/ports';
import { say } from '../model/say';
import type { Question } from './dialogs.svelte';
import type { Editor } from './editor.svelte';

export const anew_question = (): Question => ({
  title: say('make_it_anew'),
  text: say('what_was_changed_by_hand_goes'),
  yes: say('go_on'),
  danger: false,
});

export class Makings {
  #all = $state.raw<readonly Making[]>([]);
  /** Of the mission in the editor, as it is there now; null: it was made otherwise, or elsewhere. */
  readonly here = $derived.by((): Found | null => {
    const { stored, plan } = this.#editor;
    if (!stored) return null;
    return drawing_in(plan) ?? making_of(this.#all, stored.id, plan.items);
  });
  readonly #storage: DraftStorage;
  readonly #editor: Editor;

  constructor(storage: DraftStorage, editor: Editor) {
    this.#storage = storage;
    this.#editor = editor;
    this.#all = parse_makings(storage.read());
  }

  /** @param id of the mission @param items that came of what was drawn */
  keep(id: string, items: readonly Item[], drawn: Drawn): void {
    this.#all = with_making(this.#all, { id, mark: mark_of(items), drawn });
    this.#storage.write(JSON.stringify(this.#all));
  }
}
