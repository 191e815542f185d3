// Missions that were cut in two. The second part is stored as one of its own; a step back that joins them takes it
// away again, unless somebody has changed it since, and a step forward brings it back.

import { failure_text, type Refusal } from '../model/answer';
import { cuts_kept, type Cut, type KeptCut } from '../model/cuts';
import type { History } from '../model/history';
import type { Plan } from '../model/plan';
import type { MissionCalls } from '../model/ports';
import { say } from '../model/say';
import type { Notices } from './notices.svelte';

export class Splits {
  readonly #calls: MissionCalls;
  readonly #notices: Notices;
  /** What became of a second part is kept with the draft. */
  readonly #changed: () => void;
  #cuts: readonly Cut[] = [];
  /** One after the other: who steps back and forward at once means the last. */
  #before: Promise<void> = Promise.resolve();

  constructor(calls: MissionCalls, notices: Notices, changed: () => void) {
    this.#calls = calls;
    this.#notices = notices;
    this.#changed = changed;
  }

  get all(): readonly Cut[] {
    return this.#cuts;
  }

  /** Those among the steps of a history. */
  kept(history: History<Plan>): readonly KeptCut[] {
    return cuts_kept(history, this.#cuts);
  }

  /** A history came back with these. What this page knows of a second part is newer than what was kept. */
  resume(cuts: readonly Cut[]): void {
    for (const cut of cuts) {
      const known = this.#cuts.find(({ id }) => id === cut.id);
      if (known) known.first = cut.first;
      else this.#cuts = [...this.#cuts, cut];
    }
  }

  /** Stores the second part. @return what stays of the plan; null: nothing was cut */
  async make([first, second]: readonly [Plan, Plan]): Promise<Plan | null> {
    // Neither part is what was drawn.
    const answer = await this.#calls.create({ ...second, drawing: null });
    if (!answer.ok) {
      this.#notices.show('error', failure_text(say('done_kept'), answer.refusal));
      return null;
    }
    const { id, revision } = answer.value;
    const cut: Cut = {
      first: { ...first, drawing: null },
      name: second.name,
      id,
      revision,
      gone: false,
    };
    this.#cuts = [...this.#cuts, cut];
    this.#notices.show('good', say('name_is_stored_this_one_ends_where', { name: cut.name }), id);
    return cut.first;
  }

  /** The plan is stepped back from there. */
  back(from: Plan): void {
    this.#then(from, (cut) => (cut.gone ? undefined : this.#remove(cut)));
  }

  /** The plan was stepped forward to there. */
  forward(to: Plan): void {
    this.#then(to, (cut) => (cut.gone ? this.#restore(cut) : undefined));
  }

  #then(plan: Plan, step: (cut: Cut) => Promise<void> | undefined): void {
    const cut = this.#cuts.find(({ first }) => first === plan);
    if (!cut) return;
    this.#before = this.#before.then(() => step(cut)).then(this.#changed);
  }

  async #remove(cut: Cut): Promise<void> {
    const { id, name, revision } = cut;
    const answer = await this.#calls.remove(id, revision);
    cut.gone = answer.ok;
    if (!answer.ok) {
      this.#notices.show('warning', this.#stays(name, answer.refusal), id);
      return;
    }
    cut.revision += 1; // that it is deleted is a revision, too
    this.#notices.show('good', say('split_taken_back', { name }), id);
  }

  /** Why the second part is not taken back. */
  #stays(name: string, refusal: Refusal): string {
    if (refusal.status === 412) return say('split_stays', { name });
    if (refusal.status === 404) return say('split_was_deleted', { name });
    return `${name}: ${failure_text(say('done_deleted'), refusal)}`;
  }

  async #restore(cut: Cut): Promise<void> {
    const answer = await this.#calls.restore(cut.id, cut.revision);
    if (answer.ok) {
      [cut.revision, cut.gone] = [answer.value.revision, false];
      this.#notices.show(
        'good',
        say('name_is_stored_this_one_ends_where', { name: cut.name }),
        cut.id,
      );
    } else this.#notices.show('error', failure_text(say('done_kept'), answer.refusal), cut.id);
  }
}
