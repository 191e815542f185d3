// The places where the robot slipped: read while they are shown on the map.

import { refusal_text } from '../model/answer';
import { say } from '../model/say';
import type { Slip, SlipCalls } from '../model/slips';
import type { Dialogs } from './dialogs.svelte';

const NONE: readonly Slip[] = [];
const RENEWED_MS = 10_000;

export class Slips {
  shown = $state(false);
  items = $state.raw<readonly Slip[]>(NONE);
  failure = $state<string | null>(null);
  on_map = $derived(this.shown ? this.items : NONE);

  readonly #calls: SlipCalls;
  readonly #dialogs: Dialogs;

  constructor(calls: SlipCalls, dialogs: Dialogs) {
    this.#calls = calls;
    this.#dialogs = dialogs;
  }

  show(shown: boolean): void {
    this.shown = shown;
    if (shown) void this.refresh();
  }

  /** Asks now and then. @return ends it */
  watch(): () => void {
    const again = setInterval(() => void this.refresh(), RENEWED_MS);
    void this.refresh();
    return () => clearInterval(again);
  }

  async refresh(): Promise<void> {
    const answer = await this.#calls.all();
    this.failure = answer.ok ? null : refusal_text(answer.refusal);
    if (answer.ok) this.items = answer.value;
  }

  async forget(): Promise<void> {
    const sure = await this.#dialogs.ask({
      title: say('forget_where_it_slipped'),
      text: say('items_places_go_for_good_for_everybody', { items: this.items.length }),
      yes: say('forget_them'),
      danger: true,
    });
    if (!sure) return;
    const answer = await this.#calls.clear();
    this.failure = answer.ok ? null : refusal_text(answer.refusal);
    if (answer.ok) this.items = NONE;
  }
}
