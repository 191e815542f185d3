// The guided calibration drive: asked about, begun, watched, kept or discarded.

import { refusal_text, type Answer } from '../model/answer';
import type { Calibration, CalibrationKind } from '../model/calibration';
import type { VehicleCalls } from '../model/ports';
import type { Dialogs } from './dialogs.svelte';

const ASK_AGAIN_MS = 1000;

export class Calibrator {
  last = $state.raw<Calibration | null>(null);
  kind = $state<CalibrationKind>('drive');
  failure = $state<string | null>(null);
  busy = $state(false);

  readonly #calls: VehicleCalls;
  readonly #dialogs: Dialogs;

  constructor(calls: VehicleCalls, dialogs: Dialogs) {
    this.#calls = calls;
    this.#dialogs = dialogs;
  }

  /** As long as somebody looks. @return ends it */
  watch(): () => void {
    let timer: ReturnType<typeof setTimeout> | undefined;
    let over = false;
    const ask = async (): Promise<void> => {
      const answer = await this.#calls.calibration();
      if (over) return;
      if (answer.ok) this.last = answer.value;
      timer = setTimeout(() => void ask(), ASK_AGAIN_MS);
    };
    void ask();
    return () => {
      over = true;
      clearTimeout(timer);
    };
  }

  begin = (): Promise<void> => this.#do(() => this.#calls.calibrate(this.kind));
  keep = (): Promise<void> => this.#do(() => this.#calls.settle_calibration(true));
  discard = (): Promise<void> => this.#do(() => this.#calls.settle_calibration(false));

  async forget(): Promise<void> {
    const sure = await this.#dialogs.ask({
      title: 'Forget how the vehicle drives?',
      text: 'What calibrations measured and what was learned while driving is gone. It drives by its settings, and learns anew.',
      yes: 'Forget it',
      danger: true,
    });
    if (sure) await this.#do(() => this.#calls.forget_calibration());
  }

  async #do(call: () => Promise<Answer<Calibration>>): Promise<void> {
    this.busy = true;
    const answer = await call();
    this.busy = false;
    this.failure = answer.ok ? null : refusal_text(answer.refusal);
    if (answer.ok) this.last = answer.value;
  }
}
