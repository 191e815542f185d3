// A mission on its way into the robot's store: for the first time, as a new revision, beside somebody
// else's, or without an answer. What nobody answered is saved by itself when the robot answers again.

import { type Answer, failure_text, refused_items } from '../model/answer';
import type { FirstSave } from '../model/first_save';
import type { Plan } from '../model/plan';
import type { Mission, MissionCalls } from '../model/ports';
import { say } from '../model/say';
import { plan_of, same_plan } from '../model/stored_plan';
import type { Dialogs } from './dialogs.svelte';
import type { Editor } from './editor.svelte';
import type { Notices } from './notices.svelte';
import { Owed } from './owed';

export class Saving {
  busy = $state(false);
  /** Another one: another mission is on the screen. */
  #round = 0;
  readonly #owed = new Owed(() => void this.again());
  readonly #editor: Editor;
  readonly #calls: MissionCalls;
  readonly #first: FirstSave;
  readonly #notices: Notices;
  readonly #dialogs: Dialogs;

  constructor(
    editor: Editor,
    calls: MissionCalls,
    first: FirstSave,
    notices: Notices,
    dialogs: Dialogs,
  ) {
    this.#editor = editor;
    this.#calls = calls;
    this.#first = first;
    this.#notices = notices;
    this.#dialogs = dialogs;
  }

  /** It was to be saved, and nobody answered. */
  get owed(): boolean {
    return this.#owed.is;
  }

  owe(owed: boolean): void {
    if (this.#owed.set(owed)) this.#editor.write_draft();
  }

  /** Another mission comes; what is on its way is not its own. */
  begin_anew(): void {
    this.#round += 1;
    this.owe(false);
  }

  /** The robot answers again, or may. */
  async again(): Promise<void> {
    if (!this.owed) return;
    const { stored, unsaved } = this.#editor;
    if (this.busy) this.owe(true);
    else if (!unsaved) {
      // Undone meanwhile: but the robot may have it.
      this.owe(false);
      if (stored !== null) await this.#editor.stored_changed(stored.id, -1);
    } else if (this.#editor.why_not_save === null) await this.save();
    else this.owe(true);
  }

  async save(): Promise<boolean> {
    const editor = this.#editor;
    if (this.busy) return false;
    if (editor.why_not_save !== null) {
      this.#notices.show('warning', editor.why_not_save, 'save');
      return false;
    }
    this.busy = true;
    try {
      const { plan, stored } = editor;
      const round = this.#round;
      const answer =
        stored === null
          ? await this.#create(plan)
          : await this.#calls.replace(stored.id, stored.revision, plan);
      return round === this.#round ? await this.#after(plan, answer) : answer.ok;
    } finally {
      this.busy = false;
    }
  }

  /** As a mission of its own; sent again, it is the same one. */
  #create(plan: Plan): Promise<Answer<Mission>> {
    return this.#first.create(plan, () => this.#editor.write_draft());
  }

  async #after(plan: Plan, answer: Answer<Mission>): Promise<boolean> {
    const editor = this.#editor;
    const told = this.owed;
    this.owe(!answer.ok && answer.refusal.status === 0);
    if (answer.ok) {
      const { id, revision } = answer.value;
      editor.stored_as(plan, { id, revision });
      this.#notices.show(
        'good',
        say('saved_name_revision_revision', { name: plan.name, revision }),
        'save',
      );
      return true;
    }
    const { refusal } = answer;
    if (this.owed) {
      if (!told) this.#notices.show('warning', say('saved_when_the_robot_is_back'), 'save');
      return false;
    }
    if (refusal.status === 412) return this.#settle_conflict(plan, refusal.current ?? null);
    if (refusal.status === 404 && editor.stored !== null) return this.#save_as_new(plan);
    editor.refused = refused_items(refusal);
    this.#notices.show('error', failure_text(say('done_saved'), refusal), 'save');
    return false;
  }

  /** Somebody deleted it meanwhile: what is on the screen must not be lost. */
  async #save_as_new(plan: Plan): Promise<boolean> {
    this.#editor.stored = null;
    this.#notices.show('warning', say('the_stored_mission_was_deleted'));
    return this.#after(plan, await this.#create(plan));
  }

  async #settle_conflict(plan: Plan, current: Mission | null): Promise<boolean> {
    const editor = this.#editor;
    const { stored } = editor;
    if (stored === null) return false;
    const theirs = current ?? (await editor.read(stored.id));
    if (theirs === null) {
      // Whoever was not there to be asked may be there later.
      this.owe(true);
      return false;
    }
    // It was stored, and the answer was lost.
    if (same_plan(plan, plan_of(theirs))) return this.#after(plan, { ok: true, value: theirs });
    editor.theirs = plan_of(theirs);
    const choice = await this.#dialogs.conflict(stored.revision, theirs);
    editor.theirs = null;
    switch (choice) {
      case 'theirs':
        editor.adopt(theirs);
        return false;
      case 'copy': {
        const copy = { ...plan, name: say('name_copy', { name: plan.name }) };
        const answer = await this.#create(copy);
        if (answer.ok) editor.do((now) => (now === plan ? copy : { ...now, name: copy.name }));
        return this.#after(copy, answer);
      }
      case 'overwrite':
        editor.stored = { id: theirs.id, revision: theirs.revision };
        return this.#after(plan, await this.#calls.replace(theirs.id, theirs.revision, plan));
      case 'cancel':
        return false;
    }
  }
}
