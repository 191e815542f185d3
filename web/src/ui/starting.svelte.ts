// A start that is looked at: the way to its first item and the way home, on the map, before anything
// moves.

import { untrack } from 'svelte';

import type { WayHome } from '../model/homeward';
import type { LatLon } from '../model/plan';
import type { Mark, VehicleCalls } from '../model/ports';
import { robot_place } from '../model/vehicle';
import type { Dialogs } from './dialogs.svelte';
import type { Live } from './live.svelte';

export class Starting {
  /** Null: the robot has not said yet. */
  home = $state.raw<WayHome | null>(null);
  /** What is looked at; null: none. */
  preview = $derived.by(() => {
    const dialog = this.#dialogs.open;
    return dialog?.kind === 'start' ? dialog.preview : null;
  });
  /** Its first target, with the line that leads there. */
  mark = $derived.by<Mark | null>(() => {
    const from = robot_place(this.#live.vehicle);
    const to = this.preview?.first_target;
    return to && from ? { ...to, heading_deg: null, line: [from, to] } : null;
  });
  home_mark = $derived.by<Mark | null>(() =>
    this.preview && this.home?.target
      ? { ...this.home.target, heading_deg: null, line: this.home.line }
      : null,
  );

  readonly #calls: VehicleCalls;
  readonly #live: Live;
  readonly #dialogs: Dialogs;

  constructor(calls: VehicleCalls, live: Live, dialogs: Dialogs) {
    this.#calls = calls;
    this.#live = live;
    this.#dialogs = dialogs;
  }

  /** Inside an effect. @param show puts places on the map */
  keep_in_sight(show: (places: readonly LatLon[]) => Promise<void>): void {
    const looked_at = $derived(this.preview);
    $effect(() => {
      if (looked_at) untrack(() => void this.#ask_home(show));
    });
  }

  async #ask_home(show: (places: readonly LatLon[]) => Promise<void>): Promise<void> {
    this.home = null;
    const answer = await this.#calls.way_home('RTL');
    if (answer.ok) this.home = answer.value;
    await show([...(this.mark?.line ?? []), ...(this.home_mark?.line ?? [])]);
  }
}
