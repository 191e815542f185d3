// The place that the person chose on the map, and how the robot shall face there.

import { bearing_deg, distance_m } from '../model/geo';
import type { LatLon } from '../model/plan';
import type { Mark } from '../model/ports';
import { robot_place } from '../model/vehicle';
import type { Live } from './live.svelte';

export class Target {
  at = $state.raw<LatLon | null>(null);
  /** Null: as it comes. */
  heading_deg = $state<number | null>(null);
  reverse = $state(false);
  /** What it would drive around the place; null: nothing is said of it. */
  ring = $state.raw<{ readonly radius_m: number; readonly clockwise: boolean } | null>(null);
  mark = $derived<Mark | null>(
    this.at && {
      ...this.at,
      heading_deg: this.heading_deg,
      ...(this.ring ? { ring: this.ring } : {}),
    },
  );
  /** From the robot. */
  distance_m = $derived.by(() => (this.at && this.#from ? distance_m(this.#from, this.at) : null));
  bearing_deg = $derived.by(() =>
    this.at && this.#from ? bearing_deg(this.#from, this.at) : null,
  );

  readonly #live: Live;

  constructor(live: Live) {
    this.#live = live;
  }

  choose(at: LatLon): void {
    this.at = at;
    this.heading_deg = null;
  }

  clear(): void {
    this.at = null;
    this.heading_deg = null;
    this.reverse = false;
    this.ring = null;
  }

  /** Clockwise. From nothing it begins with the way that leads there. */
  turn(by_deg: number): void {
    const from = this.heading_deg ?? Math.round((this.bearing_deg ?? 0) / 10) * 10 - by_deg;
    this.heading_deg = (((from + by_deg) % 360) + 360) % 360;
  }

  get #from(): LatLon | null {
    return robot_place(this.#live.vehicle);
  }
}
