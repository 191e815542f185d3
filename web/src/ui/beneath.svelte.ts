// Other missions under the one that is edited: to see where they go, and to be caught by their points
// and lines.

import { refusal_text } from '../model/answer';
import { line_of } from '../model/beside';
import type { LineOnMap } from '../model/on_map';
import type { Plan } from '../model/plan';
import type { MissionCalls } from '../model/ports';
import { plan_of } from '../model/stored_plan';
import type { Notices } from './notices.svelte';

interface Shown {
  readonly id: string;
  readonly plan: Plan;
}

/** More would be a tangle. */
const MOST = 8;

export class Beneath {
  shown = $state.raw<readonly Shown[]>([]);
  readonly on_map = $derived<readonly LineOnMap[]>(
    this.shown.flatMap(({ plan }) => line_of(plan, 'other')),
  );
  readonly #calls: MissionCalls;
  readonly #notices: Notices;

  constructor(calls: MissionCalls, notices: Notices) {
    this.#calls = calls;
    this.#notices = notices;
  }

  has(id: string): boolean {
    return this.shown.some((each) => each.id === id);
  }

  hide(id: string): void {
    this.shown = this.shown.filter((each) => each.id !== id);
  }

  /** @return its plan; null: it could not be read */
  async read(id: string): Promise<Plan | null> {
    const answer = await this.#calls.read(id);
    if (answer.ok) return plan_of(answer.value);
    this.#notices.show('error', refusal_text(answer.refusal));
    return null;
  }

  async show(id: string): Promise<void> {
    const plan = await this.read(id);
    if (plan)
      this.shown = [...this.shown.filter((each) => each.id !== id), { id, plan }].slice(-MOST);
  }
}
