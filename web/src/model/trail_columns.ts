// A trail in columns, projected once, kept in step with the model's ring. Room for all of it is taken once: hours
// of driving cost no more than the first minute.

import type { LatLon } from './plan';
import type { Trail } from './trail';

/** Free room beyond the ring's, so that not every point moves all others. */
const SLACK = 2000;

export class TrailColumns {
  xs = new Float64Array(0);
  ys = new Float64Array(0);
  begins = new Uint8Array(0);
  speed_mps = new Float32Array(0);
  off_m = new Float32Array(0);
  /** The points are those from here up to before the end. */
  first = 0;
  end = 0;
  /** Of the trail's points, as it counts them. */
  seen = 0;
  readonly #project: (at: LatLon) => readonly [x: number, y: number];

  constructor(project: (at: LatLon) => readonly [x: number, y: number]) {
    this.#project = project;
  }

  get length(): number {
    return this.end - this.first;
  }

  follow(trail: Trail): void {
    const fresh = Math.min(trail.added - this.seen, trail.length);
    this.seen = trail.added;
    this.#make_room(trail.capacity, fresh);
    for (let k = trail.length - fresh; k < trail.length; k += 1) this.#push(trail, k);
    this.first = this.end - trail.length;
  }

  #make_room(capacity: number, fresh: number): void {
    if (this.xs.length === 0) {
      const size = capacity + SLACK;
      [this.xs, this.ys] = [new Float64Array(size), new Float64Array(size)];
      [this.speed_mps, this.off_m] = [new Float32Array(size), new Float32Array(size)];
      this.begins = new Uint8Array(size);
    }
    if (this.end + fresh <= this.xs.length) return;
    // Of the oldest, as many go as come: they need not be moved.
    const first = Math.min(this.first + Math.max(0, this.length + fresh - capacity), this.end);
    const columns = [this.xs, this.ys, this.begins, this.speed_mps, this.off_m];
    for (const column of columns) column.copyWithin(0, first, this.end);
    [this.first, this.end] = [0, this.end - first];
  }

  #push(trail: Trail, k: number): void {
    const at = trail.at(k);
    if (!at) return;
    const slot = this.end;
    [this.xs[slot], this.ys[slot]] = this.#project(at);
    this.begins[slot] = trail.begins(k) ? 1 : 0;
    const { speed_mps, off_m } = trail.driven(k);
    [this.speed_mps[slot], this.off_m[slot]] = [speed_mps, off_m];
    this.end += 1;
  }
}
