// “Come home”, before it drives: where to, how far, along which line, and why it would do nothing.
// The robot is asked again and again while somebody looks.

import { refusal_text } from '../model/answer';
import { bearing_deg } from '../model/geo';
import { why_not_home, type WayHome } from '../model/homeward';
import { why_not_choose } from '../model/modes';
import type { Mark, VehicleCalls } from '../model/ports';
import { say } from '../model/say';
import { robot_place } from '../model/vehicle';
import type { Live } from './live.svelte';

export type HomeMode = 'RTL' | 'SMART_RTL';

const ASK_AGAIN_MS = 1000;

export class Homeward {
  /** The mode that is being looked at; null: none. */
  mode = $state<HomeMode | null>(null);
  way = $state.raw<WayHome | null>(null);
  failure = $state<string | null>(null);
  bearing_deg = $derived.by<number | null>(() => {
    const from = robot_place(this.#live.vehicle);
    return from && this.way?.target ? bearing_deg(from, this.way.target) : null;
  });
  mark = $derived<Mark | null>(
    this.mode !== null && this.way?.target
      ? { ...this.way.target, heading_deg: null, line: this.way.line }
      : null,
  );
  why_not = $derived.by<string | null>(() => {
    if (this.way === null) return this.failure ?? say('the_robot_has_not_said_yet');
    const before = why_not_choose(this.#live.facts, this.mode ?? 'RTL');
    return before ?? why_not_home(this.way);
  });

  readonly #calls: VehicleCalls;
  readonly #live: Live;
  #timer: ReturnType<typeof setTimeout> | undefined;

  constructor(calls: VehicleCalls, live: Live) {
    this.#calls = calls;
    this.#live = live;
  }

  /** @return when the robot has told */
  async show(mode: HomeMode): Promise<void> {
    clearTimeout(this.#timer);
    this.mode = mode;
    this.way = null;
    await this.#ask(mode);
  }

  close(): void {
    clearTimeout(this.#timer);
    this.mode = null;
    this.way = null;
  }

  async #ask(mode: HomeMode): Promise<void> {
    const answer = await this.#calls.way_home(mode);
    if (this.mode !== mode) return;
    if (answer.ok) this.way = answer.value;
    this.failure = answer.ok ? null : refusal_text(answer.refusal);
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => void this.#ask(mode), ASK_AGAIN_MS);
  }
}
