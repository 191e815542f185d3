// What the edited mission was before: its stored revisions, one of them beside it on the map, and back
// to it.

import { failure_text, refusal_text } from '../model/answer';
import { differences, differences_words, other_on_map } from '../model/compare';
import type { LineOnMap } from '../model/on_map';
import type { Plan } from '../model/plan';
import type { MissionCalls } from '../model/ports';
import type { Revision } from '../model/revision';
import { say } from '../model/say';
import { plan_of } from '../model/stored_plan';
import type { Editor } from './editor.svelte';
import type { Notices } from './notices.svelte';

export class Revisions {
  /** Whose they are; null: the card is closed. */
  #of = $state<string | null>(null);
  items = $state.raw<readonly Revision[]>([]);
  next_cursor = $state.raw<string | null>(null);
  failure = $state<string | null>(null);
  busy = $state(false);
  /** The one that is looked at. */
  chosen = $state.raw<{ readonly revision: number; readonly plan: Plan } | null>(null);
  readonly #calls: MissionCalls;
  readonly #editor: Editor;
  readonly #notices: Notices;

  /** Those of the mission that is edited, of no other. */
  readonly open = $derived.by<boolean>(
    () => this.#of !== null && this.#of === this.#editor.stored?.id,
  );
  readonly on_map = $derived.by<readonly LineOnMap[]>(() =>
    this.open && this.chosen ? other_on_map(this.#editor.plan, this.chosen.plan, 'theirs') : [],
  );
  /** From what is edited to the one that is looked at. */
  readonly words = $derived.by<string>(() =>
    this.chosen ? differences_words(differences(this.#editor.plan, this.chosen.plan)) : '',
  );

  constructor(calls: MissionCalls, editor: Editor, notices: Notices) {
    this.#calls = calls;
    this.#editor = editor;
    this.#notices = notices;
  }

  show(): void {
    this.#of = this.#editor.stored?.id ?? null;
    this.items = [];
    this.next_cursor = this.chosen = null;
    void this.more(null);
  }

  close(): void {
    this.#of = null;
    this.chosen = null;
  }

  async more(cursor: string | null): Promise<void> {
    const { stored } = this.#editor;
    if (!stored) return;
    const answer = await this.#calls.revisions(stored.id, cursor);
    if (this.#of !== stored.id) return;
    this.failure = answer.ok ? null : refusal_text(answer.refusal);
    if (!answer.ok) return;
    this.items = cursor === null ? answer.value.items : [...this.items, ...answer.value.items];
    this.next_cursor = answer.value.next_cursor;
  }

  async look(revision: number): Promise<void> {
    const { stored } = this.#editor;
    if (this.chosen?.revision === revision) this.chosen = null;
    else if (stored) {
      const answer = await this.#calls.read_revision(stored.id, revision);
      if (this.#of !== stored.id) return;
      if (answer.ok) this.chosen = { revision, plan: plan_of(answer.value) };
      else this.#notices.show('error', refusal_text(answer.refusal));
    }
  }

  /** Stored as the newest revision; here it is one step, so undo brings the edits back. */
  async revert(): Promise<void> {
    const { stored } = this.#editor;
    const { chosen } = this;
    if (!stored || !chosen || !this.open) return;
    this.busy = true;
    const answer = await this.#calls.revert(stored.id, stored.revision, chosen.revision);
    this.busy = false;
    if (!answer.ok) {
      this.#notices.show('error', failure_text(say('done_reverted'), answer.refusal));
      return;
    }
    this.#editor.adopt(answer.value);
    this.#notices.show(
      'good',
      say('as_in_revision_revision_stored_as', {
        revision: chosen.revision,
        revision_2: answer.value.revision,
      }),
    );
    this.chosen = null;
    this.show();
  }
}
