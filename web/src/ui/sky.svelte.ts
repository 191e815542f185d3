// The satellites, while somebody looks at them.

import { refusal_text } from '../model/answer';
import type { VehicleCalls } from '../model/ports';
import type { ReceiverSky } from '../model/sky';

const RENEWED_MS = 2000;

export class Sky {
  receivers = $state.raw<readonly ReceiverSky[]>([]);
  failure = $state<string | null>(null);

  readonly #calls: VehicleCalls;

  constructor(calls: VehicleCalls) {
    this.#calls = calls;
  }

  /** Asks now and then. @return ends it */
  watch(): () => void {
    let waiting: ReturnType<typeof setTimeout> | undefined;
    let over = false;
    const again = async (): Promise<void> => {
      const answer = await this.#calls.satellites();
      this.failure = answer.ok ? null : refusal_text(answer.refusal);
      if (answer.ok) this.receivers = answer.value.receivers;
      if (!over) waiting = setTimeout(() => void again(), RENEWED_MS);
    };
    void again();
    return () => {
      over = true;
      clearTimeout(waiting);
    };
  }
}
