// The list of drivers, while somebody looks at it, and their restart.

import { failure_text, refusal_text } from '../model/answer';
import type { Driver } from '../model/drivers';
import type { VehicleCalls } from '../model/ports';
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
    let waiting: ReturnType<typeof setTimeout> | undefined;
    let over = false;
    const again = async (): Promise<void> => {
      await this.#fetch();
      if (!over) waiting = setTimeout(() => void again(), RENEWED_MS);
    };
    void again();
    return () => {
      over = true;
      clearTimeout(waiting);
    };
  }

  async restart(name: string): Promise<void> {
    const sure = await this.#dialogs.ask({
      title: `Restart the driver “${name}”?`,
      text: 'Its device is closed and opened anew. Until it is heard again the robot does without it.',
      yes: 'Restart',
      danger: false,
    });
    if (!sure || this.restarting !== null) return;
    this.restarting = name;
    const answer = await this.#calls.restart_driver(name);
    this.restarting = null;
    if (answer.ok) this.#notices.show('good', `The driver “${name}” is being restarted.`);
    else this.#notices.show('error', failure_text('restarted', answer.refusal));
    await this.#fetch();
  }

  async #fetch(): Promise<void> {
    const answer = await this.#calls.drivers();
    this.failure = answer.ok ? null : refusal_text(answer.refusal);
    if (answer.ok) this.items = answer.value.items;
  }
}
