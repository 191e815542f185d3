// Fetches what the robot drove while this page did not look.

import type { MapCalls, VehicleCalls } from '../model/ports';
import type { Live } from './live.svelte';

/** Between calls. After failures the wait doubles: a weak link has better things to carry. */
const RENEWED_MS = 60_000;
const AGAIN_MS = 3000;
const AT_LAST_MS = 300_000;

export class PastWay {
  readonly #calls: Pick<VehicleCalls, 'trail'>;
  readonly #live: Live;
  readonly #map: Pick<MapCalls, 'show_robot'>;
  /** The way before this connection is not drawn yet. */
  #missing = false;
  /** When it may be asked for. */
  #due_ms = 0;
  #again_ms = AGAIN_MS;
  #call = 0;

  constructor(calls: Pick<VehicleCalls, 'trail'>, live: Live, map: Pick<MapCalls, 'show_robot'>) {
    this.#calls = calls;
    this.#live = live;
    this.#map = map;
  }

  /** What was driven before is not known. */
  connected(): void {
    this.#missing = true;
    this.#due_ms = 0;
    this.#again_ms = AGAIN_MS;
  }

  /** Begun by live messages, so that it can be had, and they go on from it. */
  async complete(): Promise<void> {
    const { tracks } = this.#live;
    const wanted = this.#missing || tracks.full;
    if (!wanted || performance.now() < this.#due_ms) return;
    this.#due_ms = Infinity;
    const call = (this.#call += 1);
    const answer = await this.#calls.trail();
    if (call !== this.#call) return; // of the connection before: it knows less
    this.#missing = !answer.ok;
    if (!answer.ok) {
      this.#due_ms = performance.now() + this.#again_ms;
      this.#again_ms = Math.min(2 * this.#again_ms, AT_LAST_MS);
      return;
    }
    this.#due_ms = performance.now() + RENEWED_MS;
    tracks.restore(answer.value);
    this.#map.show_robot(this.#live.robot, tracks);
  }
}
