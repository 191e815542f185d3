// The list of drivers, while somebody looks at it, and their restart.

import { failure_text, refusal_text } from '../model/answer';
import type { Driver } from '../model/drivers';
import type { VehicleCalls } from '../model/ports';
import { say } from '../model/say';
import { again_and_again } from './again_and_again';
import type { Dialogs } from './dialogs.svelte';
import type { Notices } from './notices.svelte';

const RENEWED_MS = 2000;

export class Drivers {
  items = $state.raw<readonly Driver[]>([]);
  failure = $state<string | null>(null);
  restarting = $state<string | null>(null);

  readonly #calls: VehicleCalls;
  readonly #notices: Notices;
  readonly #dialogs: Dialogs;

  constructor(calls: VehicleCalls, notices: Notices, dialogs: Dialogs) {
    this.#calls = calls;
    this.#notices = notices;
    this.#dialogs = dialogs;
  }

  /** Asks now and then. @return ends it */
  watch(): () => void {
    return again_and_again(() => this.#ask(), RENEWED_MS);
  }

  async restart(name: string): Promise<void> {
    const sure = await this.#dialogs.ask({
      title: say('restart_the_driver_name', { name }),
      text: say('its_device_is_closed_and_opened_anew'),
      yes: say('restart'),
      danger: false,
    });
    if (!sure || this.restarting !== null) return;
    this.restarting = name;
    const answer = await this.#calls.restart_driver(name);
    this.restarting = null;
    this.#notices.outcome(
      `restart ${name}`, // not as what the driver itself tells, which would replace it
      answer.ok ? null : failure_text(say('done_restarted'), answer.refusal),
    );
    if (answer.ok) this.#notices.show('good', say('the_driver_name_is_being_restarted', { name }));
    (await this.#ask())();
  }

  async #ask(): Promise<() => void> {
    const answer = await this.#calls.drivers();
    return () => {
      this.failure = answer.ok ? null : refusal_text(answer.refusal);
      if (answer.ok) this.items = answer.value.items;
    };
  }
}
