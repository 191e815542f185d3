// "I am here": a person shows on the map where the robot stands and which way it looks, and is told
// what was seen to come of it.

import { bearing_deg } from '../model/geo';
import type { LatLon } from '../model/plan';
import type { Mark } from '../model/ports';
import { seen_since, type PlaceWords } from '../model/site_map';
import type { Live } from './live.svelte';
import type { Pilot } from './pilot.svelte';

export class Standing {
  /** The next press on the map shows it. */
  open = $state(false);
  at = $state.raw<LatLon | null>(null);
  /** Null: not said. */
  heading_deg = $state<number | null>(null);
  mark = $derived<Mark | null>(this.at && { ...this.at, heading_deg: this.heading_deg });
  #taken_ms = $state<number | null>(null);
  /** What came of the last one; null: nothing was said, or it is not known yet. */
  found = $derived.by<PlaceWords | null>(() => {
    const place = this.#live.vehicle?.place;
    if (this.#taken_ms === null || !place) return null;
    return seen_since(place, (this.#live.now_ms - this.#taken_ms) / 1000);
  });
  /** It was taken, and what is seen there is awaited. */
  waits = $derived(this.#taken_ms !== null && this.found === null);

  readonly #live: Live;
  readonly #pilot: Pilot;

  constructor(live: Live, pilot: Pilot) {
    this.#live = live;
    this.#pilot = pilot;
  }

  begin(): void {
    this.clear();
    this.open = true;
  }

  clear(): void {
    this.open = false;
    this.at = null;
    this.heading_deg = null;
    this.#taken_ms = null;
  }

  point(at: LatLon, toward: LatLon | null): void {
    this.at = at;
    this.heading_deg = toward && Math.round(bearing_deg(at, toward)) % 360;
  }

  /** Clockwise. */
  turn(by_deg: number): void {
    this.heading_deg = ((((this.heading_deg ?? 0) + by_deg) % 360) + 360) % 360;
  }

  async send(): Promise<void> {
    if (!this.at) return;
    const { at, heading_deg } = this;
    const pose = { ...at, ...(heading_deg === null ? {} : { heading_deg }) };
    if (!(await this.#pilot.stand_at(pose))) return;
    this.clear();
    this.#taken_ms = performance.now();
  }
}
