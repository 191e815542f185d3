// “Come home”, before it drives: where to, how far, and why it would do nothing.

import { AT_HOME_M, refuge, type Refuge } from '../model/homeward';
import { why_not_choose } from '../model/modes';
import type { Mark } from '../model/ports';
import { robot_place } from '../model/vehicle';
import type { Fences } from './fences.svelte';
import type { Live } from './live.svelte';

export type WayHome = 'RTL' | 'SMART_RTL';

export class Homeward {
  /** The way that is being looked at; null: none. */
  way = $state<WayHome | null>(null);
  target = $derived.by<Refuge | null>(() => this.#target());
  mark = $derived<Mark | null>(
    this.way === null || this.target === null ? null : { ...this.target.at, heading_deg: null },
  );
  why_not = $derived.by<string | null>(() => this.#why_not());

  readonly #live: Live;
  readonly #fences: Fences;

  constructor(live: Live, fences: Fences) {
    this.#live = live;
    this.#fences = fences;
  }

  show(way: WayHome): void {
    this.way = way;
  }

  close(): void {
    this.way = null;
  }

  #target(): Refuge | null {
    const from = robot_place(this.#live.vehicle);
    if (!from) return null;
    const home = this.#live.vehicle?.home ?? null;
    // The way it came ends at home, and keeps inside the fence by itself.
    const fence = this.way === 'SMART_RTL' ? null : this.#fences.active;
    return refuge(home, fence, from);
  }

  #why_not(): string | null {
    const before = why_not_choose(this.#live.facts, this.way ?? 'RTL');
    if (before !== null) return before;
    if (robot_place(this.#live.vehicle) === null) return 'The robot does not know where it is.';
    if (this.target === null) return 'Nothing can be reached straight inside the fence.';
    return this.target.distance_m < AT_HOME_M
      ? `It stands there already: ${this.target.name}.`
      : null;
  }
}
