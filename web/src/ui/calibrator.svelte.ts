// The guided calibration drive: asked about, begun, watched, kept or discarded.

import { refusal_text, type Answer } from '../model/answer';
import {
  kept_words,
  type Calibration,
  type CalibrationKind,
  type SpaceOnMap,
} from '../model/calibration';
import type { VehicleCalls } from '../model/ports';
import { say } from '../model/say';
import { again_and_again } from './again_and_again';
import type { Dialogs } from './dialogs.svelte';

const ASK_AGAIN_MS = 1000;

export class Calibrator {
  last = $state.raw<Calibration | null>(null);
  kind = $state<CalibrationKind>('drive');
  failure = $state<string | null>(null);
  busy = $state(false);
  /** What became of the last one, once a person has chosen. */
  said = $state<string | null>(null);
  /** The ground that it needs; null: nobody looks. */
  space = $derived.by<SpaceOnMap | null>(() => {
    const { last } = this;
    const running = last?.state === 'running';
    if (!this.#looked || !last || (last.state !== 'none' && !running)) return null;
    const need = last.kinds.find(({ kind }) => kind === (running ? last.kind : this.kind));
    if (!need) return null;
    return { corners: need.corners, possible: running || need.possible };
  });

  #looked = $state(false);
  readonly #calls: VehicleCalls;
  readonly #dialogs: Dialogs;

  constructor(calls: VehicleCalls, dialogs: Dialogs) {
    this.#calls = calls;
    this.#dialogs = dialogs;
  }

  /** As long as somebody looks. @return ends it */
  watch(): () => void {
    this.#looked = true;
    this.said = null;
    const end = again_and_again(async () => {
      const answer = await this.#calls.calibration();
      return () => {
        if (answer.ok) this.last = answer.value;
      };
    }, ASK_AGAIN_MS);
    return () => {
      this.#looked = false;
      end();
    };
  }

  begin = (): Promise<void> => this.#do(null, () => this.#calls.calibrate(this.kind));
  keep = (): Promise<void> =>
    this.#do(this.last && kept_words(this.last), () => this.#calls.settle_calibration(true));
  discard = (): Promise<void> => {
    const measured = this.last?.state === 'done';
    const said = measured ? say('discarded_it_drives_as_before') : null;
    return this.#do(said, () => this.#calls.settle_calibration(false));
  };

  async forget(): Promise<void> {
    const sure = await this.#dialogs.ask({
      title: say('forget_how_the_vehicle_drives'),
      text: say('what_calibrations_measured_and_what'),
      yes: say('forget_it'),
      danger: true,
    });
    const said = say('forgotten_it_drives_by_its_settings');
    if (sure) await this.#do(said, () => this.#calls.forget_calibration());
  }

  /** @param said once it is done */
  async #do(said: string | null, call: () => Promise<Answer<Calibration>>): Promise<void> {
    this.busy = true;
    this.said = null;
    const answer = await call();
    this.busy = false;
    this.failure = answer.ok ? null : refusal_text(answer.refusal);
    if (!answer.ok) return;
    this.last = answer.value;
    this.said = said;
  }
}
