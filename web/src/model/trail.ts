// The way the robot drove, as a bounded ring: when it is full the oldest point goes. Standing still
// adds nothing. Made of pieces: where the position jumps, no line joins one to the next. The only
// mutable value of the model: it grows ten times a second.

import { distance_m } from './geo';
import type { LatLon } from './plan';

export interface TrailPoint extends LatLon {
  /** Seconds, Unix time of the robot's clock. */
  readonly t_s: number;
}
/** What a line may join, oldest first. */
export type TrailPiece = readonly TrailPoint[];

/** What was measured where a point is; NaN: not known. */
export interface Driven {
  readonly speed_mps: number;
  /** To either side of the way of a running mission. */
  readonly off_m: number;
}
export const NOT_MEASURED: Driven = { speed_mps: Number.NaN, off_m: Number.NaN };
/** A point of the server's memory and one of our own, so near in time, are of the same place. */
const SAME_S = 1;

export class Trail {
  readonly #lat: Float64Array;
  readonly #lon: Float64Array;
  readonly #t_s: Float64Array;
  readonly #begins: Uint8Array;
  readonly #speed_mps: Float32Array;
  readonly #off_m: Float32Array;
  readonly #step_m: number;
  #first = 0;
  #count = 0;
  #added = 0;

  /** @param step_m points nearer than this to the last one are left out */
  constructor(capacity = 40_000, step_m = 0.05) {
    this.#lat = new Float64Array(capacity);
    this.#lon = new Float64Array(capacity);
    this.#t_s = new Float64Array(capacity);
    this.#begins = new Uint8Array(capacity);
    this.#speed_mps = new Float32Array(capacity);
    this.#off_m = new Float32Array(capacity);
    this.#step_m = step_m;
  }

  get length(): number {
    return this.#count;
  }

  /** So many points at most. */
  get capacity(): number {
    return this.#lat.length;
  }

  /** The next point costs the oldest. */
  get full(): boolean {
    return this.#count === this.#lat.length;
  }

  /** Grows with every point that was ever added; tells a drawer whether there is news. */
  get added(): number {
    return this.#added;
  }

  /** @param index 0 is the oldest point */
  at(index: number): TrailPoint | undefined {
    if (index < 0 || index >= this.#count) return undefined;
    const slot = this.#slot(index);
    return { lat: this.#lat[slot] ?? 0, lon: this.#lon[slot] ?? 0, t_s: this.#t_s[slot] ?? 0 };
  }

  /** No line leads to this point. */
  begins(index: number): boolean {
    return index === 0 || this.#begins[this.#slot(index)] === 1;
  }

  /** What was measured at this point. */
  driven(index: number): Driven {
    if (index < 0 || index >= this.#count) return NOT_MEASURED;
    const slot = this.#slot(index);
    return {
      speed_mps: this.#speed_mps[slot] ?? Number.NaN,
      off_m: this.#off_m[slot] ?? Number.NaN,
    };
  }

  points(): TrailPoint[] {
    const all = Array.from({ length: this.#count }, (_, k) => this.at(k));
    return all.filter((at) => at !== undefined);
  }

  /** @param reach_m farther than this from the last point is a jump @return whether it was kept */
  add(at: LatLon, t_s: number, reach_m: number, driven = NOT_MEASURED): boolean {
    const last = this.at(this.#count - 1);
    const moved_m = last ? distance_m(last, at) : Infinity;
    if (moved_m < this.#step_m) return false;
    this.#push({ ...at, t_s }, moved_m > reach_m, driven);
    return true;
  }

  /**
   * Takes over what the server remembers. Points of our own that are older than its memory stay (it
   * may have been started anew); all others are in it, and go. It knows places alone: what was measured
   * there is taken from those that go. @param until_s when it was told
   */
  restore(pieces: readonly TrailPiece[], until_s: number): void {
    const since_s = pieces[0]?.[0]?.t_s ?? until_s;
    const own = this.points().map((at, k) => ({
      at,
      begins: this.begins(k),
      driven: this.driven(k),
    }));
    this.clear();
    for (const { at, begins, driven } of own) {
      if (at.t_s < since_s) this.#push(at, begins, driven);
    }
    let next = 0;
    const off_s = (k: number, t_s: number): number => Math.abs((own[k]?.at.t_s ?? Infinity) - t_s);
    for (const piece of pieces) {
      piece.forEach((at, k) => {
        while (off_s(next + 1, at.t_s) <= off_s(next, at.t_s) && next + 1 < own.length) next += 1;
        const known = off_s(next, at.t_s) <= SAME_S ? own[next]?.driven : undefined;
        this.#push(at, k === 0, known ?? NOT_MEASURED);
      });
    }
  }

  clear(): void {
    this.#first = 0;
    this.#count = 0;
    this.#added += 1;
  }

  #slot(index: number): number {
    return (this.#first + index) % this.#lat.length;
  }

  #push(at: TrailPoint, begins: boolean, { speed_mps, off_m }: Driven): void {
    const slot = this.#slot(this.#count);
    this.#lat[slot] = at.lat;
    this.#lon[slot] = at.lon;
    this.#t_s[slot] = at.t_s;
    this.#begins[slot] = begins ? 1 : 0;
    this.#speed_mps[slot] = speed_mps;
    this.#off_m[slot] = off_m;
    if (this.#count < this.#lat.length) this.#count += 1;
    else this.#first = (this.#first + 1) % this.#lat.length;
    this.#added += 1;
  }
}
