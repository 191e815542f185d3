// What the check says about the mission that the robot has loaded. It is looked at before arming:
// when the mission is loaded, and again where the robot has moved since.

import { distance_m } from '../model/geo';
import type { LatLon } from '../model/plan';
import type { CheckReport, MissionCalls } from '../model/ports';
import { robot_place, type Vehicle } from '../model/vehicle';

/** The approach and the distances of a check belong to a place. */
const MOVED_M = 2;
const AGAIN_MS = 5000;

export class Findings {
  /** Null: nothing is loaded, or it is not known yet. */
  report = $state.raw<CheckReport | null>(null);
  name = $state<string | null>(null);

  readonly #calls: MissionCalls;
  #key = '';
  #from: LatLon | null = null;
  #due_ms = 0;
  #asking = false;

  constructor(calls: MissionCalls) {
    this.#calls = calls;
  }

  /** A state of the robot came. An armed robot is not asked: it drives, or is about to. */
  take({ armed, mission, ...rest }: Vehicle): void {
    const { id, revision } = mission;
    const key = id === null || revision === null ? '' : `${id} ${revision}`;
    const at = robot_place({ armed, mission, ...rest });
    if (key !== this.#key) {
      this.#key = key;
      this.report = null;
      this.name = mission.name;
      this.#from = null;
      this.#due_ms = 0;
    }
    if (id === null || revision === null || armed) return;
    const moved = at !== null && (this.#from === null || distance_m(this.#from, at) > MOVED_M);
    const wanted = this.report === null || moved;
    if (wanted && !this.#asking && performance.now() >= this.#due_ms) {
      void this.#ask(id, revision, key, at);
    }
  }

  async #ask(id: string, revision: number, key: string, at: LatLon | null): Promise<void> {
    this.#asking = true;
    const answer = await this.#calls.check(id, revision);
    this.#asking = false;
    this.#due_ms = performance.now() + AGAIN_MS;
    if (key !== this.#key || !answer.ok) return;
    this.#from = at;
    this.report = answer.value;
  }
}
