// What becomes a mission when it is kept: asked for as it is changed, shown as it would be. It stays one
// object: taken up again later, the mission's points follow.

import { refusal_text, type Refusal } from '../model/answer';
import { drawing_of, same_drawn, type Drawn } from '../model/makings';
import type { Plan } from '../model/plan';
import type { PlanningCalls } from '../model/ports';
import { say } from '../model/say';
import type { Editor } from './editor.svelte';
import type { Makings } from './makings.svelte';
import type { Notices } from './notices.svelte';

const ASK_AFTER_MS = 350;

export abstract class Planner<Wish, Result extends { readonly plan: Plan }> {
  /** The person plans this instead of a mission. */
  open = $state(false);
  name = $state('');
  result = $state.raw<Result | null>(null);
  failure = $state<string | null>(null);
  busy = $state(false);
  /** The mission whose drawing is taken up again; null: a new one is made. */
  #remade = $state<string | null>(null);

  abstract readonly wish: Wish;
  /** Why there is nothing to work out yet. */
  abstract readonly why_not: string | null;

  readonly #calls: PlanningCalls<Wish, Result>;
  readonly #editor: Editor;
  readonly #notices: Notices;
  readonly #makings: Makings;
  #timer: ReturnType<typeof setTimeout> | undefined;
  #question = 0;

  constructor(
    calls: PlanningCalls<Wish, Result>,
    editor: Editor,
    notices: Notices,
    makings: Makings,
  ) {
    this.#calls = calls;
    this.#editor = editor;
    this.#notices = notices;
    this.#makings = makings;
  }

  /** The mission in the editor gets other points; else a new one is made. */
  get remakes(): boolean {
    return this.#remade !== null && this.#remade === this.#editor.stored?.id;
  }

  /** Nothing is drawn any more. */
  protected abstract clear(): void;
  /** As it is drawn now. */
  protected abstract drawn_now(): Drawn;

  /** What the mission was made of is drawn again. @param id of the mission */
  protected take_up(id: string): void {
    this.#remade = id;
    this.open = true;
  }

  /** What was drawn stays for the next time, but for what belongs to a mission. */
  close(): void {
    this.open = false;
    if (this.#remade !== null) this.clear();
    this.#remade = null;
  }

  /** Asks anew a moment after the last change. Called by an effect that reads both. */
  keep_up(wish: Wish, why_not: string | null): void {
    clearTimeout(this.#timer);
    this.#question += 1;
    if (why_not !== null) {
      this.result = null;
      this.failure = null;
      this.busy = false;
      return;
    }
    this.busy = true;
    const question = this.#question;
    this.#timer = setTimeout(() => void this.#ask(wish, question), ASK_AFTER_MS);
  }

  /** Stores it and puts it into the editor, or gives the mission there other points and saves it.
   * @return whether it is in the editor */
  async keep(): Promise<boolean> {
    if (this.remakes) return this.#remake();
    const { result } = this;
    if (result === null || !(await this.#editor.may_discard())) return false;
    const drawn = this.drawn_now();
    const { items } = result.plan;
    const name = this.name.trim();
    this.busy = true;
    const mission = await this.#editor.keep_as_new({
      ...result.plan,
      name,
      drawing: drawing_of(drawn, items),
    });
    this.busy = false;
    if (mission === null) return false;
    this.#makings.keep(mission.id, mission.items, drawn);
    this.#notices.show('good', say('kept_name_as_a_mission', { name }));
    this.close();
    this.clear();
    return true;
  }

  /** One step, which can be undone; name, home and what else was set stay. */
  async #remake(): Promise<boolean> {
    const { result } = this;
    const editor = this.#editor;
    const id = this.#remade;
    if (result === null || id === null) return false;
    const { items, settings } = result.plan;
    const drawn = this.drawn_now();
    const before = this.#makings.here;
    if (before && !before.by_hand && same_drawn(before.drawn, drawn)) {
      this.close();
      return true;
    }
    this.#makings.keep(id, items, drawn);
    const drawing = drawing_of(drawn, items);
    editor.do((plan) => ({ ...plan, items, settings: { ...plan.settings, ...settings }, drawing }));
    editor.choose_tool('edit');
    editor.select(null);
    this.close();
    await editor.save();
    return true;
  }

  async #ask(wish: Wish, question: number): Promise<void> {
    const answer = await this.#calls.preview(wish);
    if (question !== this.#question) return;
    this.busy = false;
    this.result = answer.ok ? answer.value : null;
    this.failure = answer.ok ? null : this.words_of(answer.refusal);
  }

  /** Why it cannot be made so. */
  protected words_of(refusal: Refusal): string {
    return refusal_text(refusal);
  }
}
