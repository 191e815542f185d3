// The mission that a restart of the robot's program left behind: to go on with, or to forget.

import { failure_text } from '../model/answer';
import { count } from '../model/format';
import type { LeftBehind, VehicleCalls } from '../model/ports';
import { say } from '../model/say';
import type { Dialogs } from './dialogs.svelte';
import type { Notices } from './notices.svelte';
import type { Pilot } from './pilot.svelte';

/** An answer may be lost, or be a refusal: a program that has just begun may not have read yet what the
 * one before it left. */
const AGAIN_AFTER_MS: readonly number[] = [1000, 4000, 10_000];

export class Resumption {
  left_behind = $state.raw<LeftBehind | null>(null);
  busy = $state(false);
  #later: readonly ReturnType<typeof setTimeout>[] = [];

  readonly #calls: VehicleCalls;
  readonly #pilot: Pilot;
  readonly #notices: Notices;
  readonly #dialogs: Dialogs;

  constructor(calls: VehicleCalls, pilot: Pilot, notices: Notices, dialogs: Dialogs) {
    this.#calls = calls;
    this.#pilot = pilot;
    this.#notices = notices;
    this.#dialogs = dialogs;
  }

  /** On every new connection. */
  connected(): void {
    void this.refresh();
    for (const each of this.#later) clearTimeout(each);
    this.#later = AGAIN_AFTER_MS.map((after_ms) =>
      setTimeout(() => {
        if (this.left_behind === null) void this.refresh();
      }, after_ms),
    );
  }

  /** When another mission is in hand. */
  async refresh(): Promise<void> {
    const answer = await this.#calls.left_behind();
    if (answer.ok) this.left_behind = answer.value;
  }

  async go_on(): Promise<void> {
    if (await this.#pilot.resume()) this.left_behind = null;
  }

  async forget(): Promise<void> {
    const left = this.left_behind;
    if (!left || this.busy) return;
    const sure = await this.#dialogs.ask({
      title: say('forget_where_it_was'),
      text: say('name_stays_stored_with_items_the', {
        name: left.name,
        items: count(left.items, 'item'),
        item: left.item ?? '—',
      }),
      yes: say('forget_it'),
      danger: false,
    });
    if (!sure) return;
    this.busy = true;
    const answer = await this.#calls.forget_left_behind();
    this.busy = false;
    if (!answer.ok)
      this.#notices.show('error', failure_text(say('done_forgotten'), answer.refusal));
    await this.refresh();
  }
}
