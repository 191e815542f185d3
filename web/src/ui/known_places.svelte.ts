// The places that people entered for the robot to know itself by: read while somebody looks at them.

import { refusal_text } from '../model/answer';
import type { KnownPlace, KnownPlaceCalls, NewKnownPlace } from '../model/known_places';
import { say } from '../model/say';
import { again_and_again } from './again_and_again';
import type { Dialogs } from './dialogs.svelte';

const NONE: readonly KnownPlace[] = [];
const RENEWED_MS = 1000;

export class KnownPlaces {
  /** Null: not read yet. */
  items = $state.raw<readonly KnownPlace[] | null>(null);
  failure = $state<string | null>(null);
  /** A list of them is open. */
  open = $state(false);
  shown = $state(true);
  busy = $state(false);
  on_map = $derived<readonly KnownPlace[]>(this.open && this.shown ? (this.items ?? NONE) : NONE);

  readonly #calls: KnownPlaceCalls;
  readonly #dialogs: Dialogs;

  constructor(calls: KnownPlaceCalls, dialogs: Dialogs) {
    this.#calls = calls;
    this.#dialogs = dialogs;
  }

  /** Asks again and again. @return ends it */
  watch(): () => void {
    return again_and_again(async () => {
      const answer = await this.#calls.all();
      return () => {
        this.failure = answer.ok ? null : refusal_text(answer.refusal);
        if (answer.ok) this.items = answer.value;
      };
    }, RENEWED_MS);
  }

  /** @return why not; null: it is known. */
  async enter(name: string, place: NewKnownPlace): Promise<string | null> {
    this.busy = true;
    const answer = await this.#calls.enter(name, place);
    this.busy = false;
    if (!answer.ok) return refusal_text(answer.refusal);
    await this.#refresh();
    return null;
  }

  async forget(place: KnownPlace): Promise<void> {
    const sure = await this.#dialogs.ask({
      title: say('forget_known_name', { name: place.name }),
      text: say('the_robot_knows_itself_by_it_no_more'),
      yes: say('forget_it'),
      danger: true,
    });
    if (!sure) return;
    const answer = await this.#calls.forget(place.name);
    this.failure = answer.ok ? null : refusal_text(answer.refusal);
    await this.#refresh();
  }

  async #refresh(): Promise<void> {
    const answer = await this.#calls.all();
    if (answer.ok) this.items = answer.value;
  }
}
