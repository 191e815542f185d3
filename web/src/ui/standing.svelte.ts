// "I am here": a person shows on the map where the robot stands and which way it looks, and is told
// what was seen to come of it.

import { bearing_deg, distance_m } from '../model/geo';
import type { LatLon } from '../model/plan';
import type { Mark } from '../model/ports';
import { seen_since, type PlaceWords } from '../model/site_map';
import { robot_place, type Vehicle } from '../model/vehicle';
import type { Live } from './live.svelte';
import type { Pilot } from './pilot.svelte';

/** By then what is seen there has been looked at. */
const SOON_S = 1.5;
/** Later it has nothing to do any more with what was said. */
const KEPT_S = 30;

interface Told {
  readonly at: LatLon;
  readonly taken_ms: number;
}

export class Standing {
  /** The next press on the map shows it. */
  open = $state(false);
  at = $state.raw<LatLon | null>(null);
  /** Null: not said. */
  heading_deg = $state<number | null>(null);
  mark = $derived<Mark | null>(this.at && { ...this.at, heading_deg: this.heading_deg });
  #told = $state.raw<Told | null>(null);
  #seen = $state.raw<PlaceWords | null>(null);
  /** What was shown before the press that goes on. */
  #before: Mark | null = null;
  #asked = $derived.by<boolean>(
    () => this.#told !== null && this.#live.now_ms - this.#told.taken_ms < KEPT_S * 1000,
  );
  /** What came of the last one; null: nothing was said, or it is not known yet. */
  found = $derived<PlaceWords | null>(this.#asked ? this.#seen : null);
  /** It was taken, and what is seen there is awaited. */
  waits = $derived(this.#asked && this.found === null);

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
    this.#told = null;
    this.#seen = null;
    this.#before = null;
  }

  /** @param at another object with every press; null: the press meant nothing */
  point(at: LatLon | null, toward: LatLon | null): void {
    if (at === null) {
      this.at = this.#before && { lat: this.#before.lat, lon: this.#before.lon };
      this.heading_deg = this.#before?.heading_deg ?? null;
      return;
    }
    if (at !== this.at) this.#before = this.mark;
    this.at = at;
    this.heading_deg = toward && Math.round(bearing_deg(at, toward)) % 360;
  }

  /** Clockwise; at first from where the robot takes itself to look. */
  turn(by_deg: number): void {
    const from_deg = this.heading_deg ?? this.#live.robot?.heading_deg ?? 0;
    this.heading_deg = Math.round((((from_deg + by_deg) % 360) + 360) % 360) % 360;
  }

  /** Only what is told after it was taken says what came of it. */
  take(vehicle: Vehicle): void {
    if (!this.#told || !vehicle.place || this.#live.stale || this.#seen?.tone === 'good') return;
    const after_s = (performance.now() - this.#told.taken_ms) / 1000;
    if (after_s < SOON_S || after_s > KEPT_S) return;
    const here = robot_place(vehicle);
    this.#seen = seen_since(vehicle.place, after_s, here && distance_m(here, this.#told.at));
  }

  async send(): Promise<void> {
    if (!this.at) return;
    const { at, heading_deg } = this;
    const pose = { ...at, ...(heading_deg === null ? {} : { heading_deg }) };
    if (!(await this.#pilot.stand_at(pose))) return;
    this.clear();
    this.#told = { at, taken_ms: performance.now() };
  }
}
