// Missions that were cut in two. The second part is stored as one of its own; a step back that joins them takes it
// away again, unless somebody has changed it since, and a step forward brings it back.

import { failure_text } from '../model/answer';
import type { Plan } from '../model/plan';
import type { MissionCalls } from '../model/ports';
import { say } from '../model/say';
import type { Notices } from './notices.svelte';

interface Cut {
  readonly first: Plan;
  readonly name: string;
  readonly id: string;
  revision: number;
  gone: boolean;
}

export class Splits {
  readonly #calls: MissionCalls;
  readonly #notices: Notices;
  #cuts: readonly Cut[] = [];
  /** One after the other: who steps back and forward at once means the last. */
  #before: Promise<void> = Promise.resolve();

  constructor(calls: MissionCalls, notices: Notices) {
    this.#calls = calls;
    this.#notices = notices;
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
    if (cut) this.#before = this.#before.then(() => step(cut));
  }

  async #remove(cut: Cut): Promise<void> {
    const { id, name, revision } = cut;
    const answer = await this.#calls.remove(id, revision);
    cut.gone = answer.ok;
    if (answer.ok) cut.revision += 1; // that it is deleted is a revision, too
    if (answer.ok) this.#notices.show('good', say('split_taken_back', { name }), id);
    else this.#notices.show('warning', say('split_stays', { name }), id);
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
