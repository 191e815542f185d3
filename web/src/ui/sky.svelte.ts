// The satellites, while somebody looks at them.

import { refusal_text } from '../model/answer';
import type { VehicleCalls } from '../model/ports';
import type { ReceiverSky } from '../model/sky';
import { again_and_again } from './again_and_again';

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
    return again_and_again(async () => {
      const answer = await this.#calls.satellites();
      return () => {
        this.failure = answer.ok ? null : refusal_text(answer.refusal);
        if (answer.ok) this.receivers = answer.value.receivers;
      };
    }, RENEWED_MS);
  }
}
