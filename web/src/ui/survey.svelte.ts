// A field that is drawn, the tracks that would cover it, and the mission that they become.

import { failure_text, refusal_text } from '../model/answer';
import { spots } from '../model/plan';
import type { RunOnMap, SurveyCalls } from '../model/ports';
import { why_not_survey, type Survey, type SurveyWish } from '../model/survey';
import { Outline } from './drawing.svelte';
import type { Editor } from './editor.svelte';
import type { Notices } from './notices.svelte';

const ASK_AFTER_MS = 350;

export class Surveyor {
  /** The person draws a field instead of a mission. */
  open = $state(false);
  name = $state('Field');
  spacing_m = $state(1);
  direction_deg = $state<number | null>(null);
  turn = $state<'pivot' | 'arc'>('pivot');
  radius_m = $state(2);
  headland_passes = $state(1);
  speed_mps = $state<number | null>(null);
  result = $state.raw<Survey | null>(null);
  failure = $state<string | null>(null);
  busy = $state(false);
  readonly outline = new Outline();

  wish = $derived<SurveyWish>({
    polygon: this.outline.places,
    spacing_m: this.spacing_m,
    direction_deg: this.direction_deg,
    turn: this.turn,
    radius_m: this.radius_m,
    headland_passes: this.headland_passes,
    speed_mps: this.speed_mps,
  });
  why_not = $derived(why_not_survey(this.wish));
  on_map = $derived<readonly RunOnMap[]>(
    this.result ? [{ lines: [spots(this.result.plan)], planned: [] }] : [],
  );

  readonly #calls: SurveyCalls;
  readonly #editor: Editor;
  readonly #notices: Notices;
  #timer: ReturnType<typeof setTimeout> | undefined;
  #question = 0;

  constructor(calls: SurveyCalls, editor: Editor, notices: Notices) {
    this.#calls = calls;
    this.#editor = editor;
    this.#notices = notices;
  }

  /** Asks anew a moment after the last change. Called by an effect that reads `wish`. */
  keep_up(wish: SurveyWish): void {
    clearTimeout(this.#timer);
    this.#question += 1;
    if (why_not_survey(wish) !== null) {
      this.result = null;
      this.failure = null;
      this.busy = false;
      return;
    }
    this.busy = true;
    const question = this.#question;
    this.#timer = setTimeout(() => void this.#ask(wish, question), ASK_AFTER_MS);
  }

  /** Stores it and puts it into the editor. @return whether that was done */
  async keep(): Promise<boolean> {
    if (!(await this.#editor.may_discard())) return false;
    this.busy = true;
    const answer = await this.#calls.keep(this.wish, this.name.trim());
    this.busy = false;
    if (!answer.ok) {
      this.#notices.show('error', failure_text('kept', answer.refusal));
      return false;
    }
    this.#editor.show_mission(answer.value);
    this.#notices.show('good', `Kept “${answer.value.name}” as a mission.`);
    this.open = false;
    this.outline.clear();
    return true;
  }

  async #ask(wish: SurveyWish, question: number): Promise<void> {
    const answer = await this.#calls.preview(wish);
    if (question !== this.#question) return;
    this.busy = false;
    this.result = answer.ok ? answer.value : null;
    this.failure = answer.ok ? null : refusal_text(answer.refusal);
  }
}
