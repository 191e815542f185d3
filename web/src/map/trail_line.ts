// Draws the driven trail: a line in pieces, in one colour or in classes, or dots.

import type { Trail } from '../model/trail';
import { class_of, CLASSES, PLAIN_CLASS, type TrailShades } from '../model/trail_shades';
import { stroke_cased, trace_open, type Paint } from './canvas';
import type { Palette } from './palette';
import { to_plane, type PlanePoint } from './projection';
import { TRAIL_WIDTHS_PX } from '../model/trail_colors';

const DOTS_APART_PX = 7;
/** So many new points are drawn anew each time; then all is drawn once more. */
const TIP = 120;

/** Free room beyond the ring's, so that not every point moves all others. */
const SLACK = 2000;

/** A trail in the plane, kept in step with the model's ring: a line in pieces, or dots. Room for all of it is
 * taken once: hours of driving cost no more than the first minute. */
export class TrailLine {
  #xs = new Float64Array(0);
  #ys = new Float64Array(0);
  #begins = new Uint8Array(0);
  #speed_mps = new Float32Array(0);
  #off_m = new Float32Array(0);
  /** The points are those from here up to before the end. */
  #first = 0;
  #end = 0;
  #seen = 0;
  /** Up to where it is being drawn with what stays. */
  #begun = 0;
  /** Up to where it is seen with what stays. */
  #kept = 0;

  follow(trail: Trail): void {
    const fresh = Math.min(trail.added - this.#seen, trail.length);
    this.#seen = trail.added;
    this.#make_room(trail.capacity, fresh);
    for (let k = trail.length - fresh; k < trail.length; k += 1) this.#push(trail, k);
    this.#first = this.#end - trail.length;
  }

  #make_room(capacity: number, fresh: number): void {
    if (this.#xs.length === 0) {
      const size = capacity + SLACK;
      [this.#xs, this.#ys] = [new Float64Array(size), new Float64Array(size)];
      [this.#speed_mps, this.#off_m] = [new Float32Array(size), new Float32Array(size)];
      this.#begins = new Uint8Array(size);
    }
    if (this.#end + fresh <= this.#xs.length) return;
    // Of the oldest, as many go as come: they need not be moved.
    const first = Math.min(this.#first + Math.max(0, this.#length + fresh - capacity), this.#end);
    const columns = [this.#xs, this.#ys, this.#begins, this.#speed_mps, this.#off_m];
    for (const column of columns) column.copyWithin(0, first, this.#end);
    [this.#first, this.#end] = [0, this.#end - first];
  }

  #push(trail: Trail, k: number): void {
    const at = trail.at(k);
    if (!at) return;
    const slot = this.#end;
    [this.#xs[slot], this.#ys[slot]] = to_plane(at);
    this.#begins[slot] = trail.begins(k) ? 1 : 0;
    const { speed_mps, off_m } = trail.driven(k);
    [this.#speed_mps[slot], this.#off_m[slot]] = [speed_mps, off_m];
    this.#end += 1;
  }

  get #length(): number {
    return this.#end - this.#first;
  }

  /** All of it is drawn from now on. */
  begin(): void {
    this.#begun = this.#seen;
  }

  /** What was there at the begin is seen now. */
  keep(): void {
    this.#kept = this.#begun;
  }

  /** Index from which on it was added since; null: all of it is another one, or much is new. */
  tip(): number | null {
    const fresh = this.#seen - this.#kept;
    return fresh > TIP || fresh > this.#length ? null : Math.max(0, this.#length - fresh - 1);
  }

  /** Points of the plane, from an index on. */
  *places(first: number): Generator<PlanePoint> {
    for (let k = this.#first + first; k < this.#end; k += 1) {
      yield [this.#xs[k] ?? 0, this.#ys[k] ?? 0];
    }
  }

  /** A dot for every point that is not too near to the dot before. */
  paint_dots(paint: Paint, color: string, begin = 0): void {
    const { context } = paint;
    let [last_x, last_y] = [Number.NaN, Number.NaN];
    context.beginPath();
    for (let k = this.#first + begin; k < this.#end; k += 1) {
      const x = paint.x_px(this.#xs[k] ?? 0);
      const y = paint.y_px(this.#ys[k] ?? 0);
      if (Math.hypot(x - last_x, y - last_y) < DOTS_APART_PX) continue;
      context.rect(x - 2.5, y - 2.5, 5, 5);
      [last_x, last_y] = [x, y];
    }
    context.fillStyle = color;
    context.fill();
  }

  paint_line(paint: Paint, colors: Palette, begin = 0): void {
    if (this.#length < begin + 2) return;
    paint.context.beginPath();
    let first = this.#first + begin;
    for (let k = first + 1; k <= this.#end; k += 1) {
      if (k < this.#end && !this.#begins[k]) continue;
      trace_open(paint, this.#xs, this.#ys, first, k);
      first = k;
    }
    stroke_cased(paint.context, colors.casing, colors.trail, 3);
  }

  /** Each leg in the class of the point that it leads to: few paths, whatever was driven. */
  paint_shaded(paint: Paint, colors: Palette, shades: TrailShades, begin = 0): void {
    const legs = this.#legs_by_class(shades, begin);
    const { context } = paint;
    context.lineJoin = 'round';
    context.lineCap = 'round';
    // All casings first: none of them cuts through the line of another class.
    for (const casing of [true, false]) {
      for (let k = PLAIN_CLASS; k >= 0; k -= 1) {
        const found = legs[k] ?? [];
        if (found.length === 0) continue;
        context.beginPath();
        for (const [first, end] of found) trace_open(paint, this.#xs, this.#ys, first, end);
        const width_px = TRAIL_WIDTHS_PX[k] ?? 3;
        context.lineWidth = casing ? width_px + 3 : width_px;
        context.strokeStyle = casing ? colors.casing : (colors.trail_classes[k] ?? colors.trail);
        context.stroke();
      }
    }
  }

  /** First point and end of what is drawn in one go, for each class. */
  #legs_by_class(shades: TrailShades, begin: number): [first: number, end: number][][] {
    const legs = Array.from({ length: CLASSES + 1 }, (): [number, number][] => []);
    let [open, last] = [-1, null as [number, number] | null];
    for (let k = this.#first + begin + 1; k < this.#end; k += 1) {
      if (this.#begins[k]) {
        last = null;
        continue;
      }
      const [speed_mps = Number.NaN, off_m = Number.NaN] = [this.#speed_mps[k], this.#off_m[k]];
      const at = class_of(shades, { speed_mps, off_m });
      if (last && at === open) {
        last[1] = k + 1;
        continue;
      }
      last = [k - 1, k + 1];
      open = at;
      legs[at]?.push(last);
    }
    return legs;
  }
}
