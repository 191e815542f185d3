// A mission that is stored for the first time, over a link that may lose the answer.

import type { Answer } from './answer';
import type { Tried } from './draft';
import type { Plan } from './plan';
import type { Mission, MissionCalls } from './ports';

/** A robot that is busy or in trouble says nothing of what arrived before. */
const said_no = (status: number): boolean => status !== 0 && status !== 429 && status < 500;

export class FirstSave {
  /** Kept with the draft; null: nothing is open. */
  tried: Tried | null = null;
  readonly #calls: MissionCalls;
  readonly #fresh_key: () => string;

  /** @param fresh_key another one each time */
  constructor(calls: MissionCalls, fresh_key: () => string) {
    this.#calls = calls;
    this.#fresh_key = fresh_key;
  }

  /** What was sent before, and may have arrived, becomes this one: else there were two.
   * @param keep before it is sent, on the device */
  async create(plan: Plan, keep: () => void): Promise<Answer<Mission>> {
    const tried = this.tried ?? { key: this.#fresh_key(), plan };
    this.tried = tried;
    keep();
    const answer = await this.#calls.create(tried.plan, tried.key);
    const is_known = answer.ok || said_no(answer.refusal.status);
    if (!answer.ok || JSON.stringify(tried.plan) === JSON.stringify(plan)) {
      if (is_known) this.tried = null;
      return answer;
    }
    const replaced = await this.#calls.replace(answer.value.id, answer.value.revision, plan);
    if (replaced.ok) this.tried = null;
    if (replaced.ok || ![404, 412].includes(replaced.refusal.status)) return replaced;
    // Somebody has made another one of it meanwhile, or deleted it: this is a mission of its own.
    this.tried = null;
    return this.create(plan, keep);
  }
}
