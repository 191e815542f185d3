// The way the robot drove, as a bounded ring: when it is full the oldest point goes. Standing still
// adds nothing. The only mutable value of the model: it grows ten times a second.

import { distance_m } from './geo';
import type { LatLon } from './plan';

export class Trail {
  readonly #lat: Float64Array;
  readonly #lon: Float64Array;
  readonly #step_m: number;
  #first = 0;
  #count = 0;
  #added = 0;

  /** @param step_m points nearer than this to the last one are left out */
  constructor(capacity = 20_000, step_m = 0.05) {
    this.#lat = new Float64Array(capacity);
    this.#lon = new Float64Array(capacity);
    this.#step_m = step_m;
  }

  get length(): number {
    return this.#count;
  }

  /** Grows with every point that was ever added; tells a drawer whether there is news. */
  get added(): number {
    return this.#added;
  }

  /** @param index 0 is the oldest point */
  at(index: number): LatLon | undefined {
    if (index < 0 || index >= this.#count) return undefined;
    const slot = (this.#first + index) % this.#lat.length;
    return { lat: this.#lat[slot] ?? 0, lon: this.#lon[slot] ?? 0 };
  }

  /** @return whether the point was kept */
  add(at: LatLon): boolean {
    const last = this.at(this.#count - 1);
    if (last && distance_m(last, at) < this.#step_m) return false;
    const slot = (this.#first + this.#count) % this.#lat.length;
    this.#lat[slot] = at.lat;
    this.#lon[slot] = at.lon;
    if (this.#count < this.#lat.length) this.#count += 1;
    else this.#first = (this.#first + 1) % this.#lat.length;
    this.#added += 1;
    return true;
  }

  clear(): void {
    this.#first = 0;
    this.#count = 0;
    this.#added += 1;
  }
}
