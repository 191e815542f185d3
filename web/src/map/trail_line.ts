// Draws the driven trail: a line in pieces, in one colour or in classes, or dots.

import type { Trail } from '../model/trail';
import { TrailColumns } from '../model/trail_columns';
import { class_of, CLASSES, PLAIN_CLASS, type TrailShades } from '../model/trail_shades';
import { stroke_cased, trace_open, type Paint } from './canvas';
import type { Palette } from './palette';
import { to_plane, type PlanePoint } from './projection';
import { TRAIL_WIDTHS_PX } from '../model/trail_colors';

const DOTS_APART_PX = 7;
/** So many new points are drawn anew each time; then all is drawn once more. */
const TIP = 120;

/** A trail in the plane: a line in pieces, or dots. */
export class TrailLine {
  readonly #at = new TrailColumns(to_plane);
  /** Up to where it is being drawn with what stays. */
  #begun = 0;
  /** Up to where it is seen with what stays. */
  #kept = 0;

  follow(trail: Trail): void {
    this.#at.follow(trail);
  }

  /** All of it is drawn from now on. */
  begin(): void {
    this.#begun = this.#at.seen;
  }

  /** What was there at the begin is seen now. */
  keep(): void {
    this.#kept = this.#begun;
  }

  /** Index from which on it was added since; null: all of it is another one, or much is new. */
  tip(): number | null {
    const fresh = this.#at.seen - this.#kept;
    return fresh > TIP || fresh > this.#at.length ? null : Math.max(0, this.#at.length - fresh - 1);
  }

  /** Points of the plane, from an index on. */
  *places(first: number): Generator<PlanePoint> {
    for (let k = this.#at.first + first; k < this.#at.end; k += 1) {
      yield [this.#at.xs[k] ?? 0, this.#at.ys[k] ?? 0];
    }
  }

  /** A dot for every point that is not too near to the dot before. */
  paint_dots(paint: Paint, color: string, begin = 0): void {
    const { context } = paint;
    let [last_x, last_y] = [Number.NaN, Number.NaN];
    context.beginPath();
    for (let k = this.#at.first + begin; k < this.#at.end; k += 1) {
      const x = paint.x_px(this.#at.xs[k] ?? 0);
      const y = paint.y_px(this.#at.ys[k] ?? 0);
      if (Math.hypot(x - last_x, y - last_y) < DOTS_APART_PX) continue;
      context.rect(x - 2.5, y - 2.5, 5, 5);
      [last_x, last_y] = [x, y];
    }
    context.fillStyle = color;
    context.fill();
  }

  paint_line(paint: Paint, colors: Palette, begin = 0): void {
    if (this.#at.length < begin + 2) return;
    paint.context.beginPath();
    let first = this.#at.first + begin;
    for (let k = first + 1; k <= this.#at.end; k += 1) {
      if (k < this.#at.end && !this.#at.begins[k]) continue;
      trace_open(paint, this.#at.xs, this.#at.ys, first, k);
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
        for (const [first, end] of found) trace_open(paint, this.#at.xs, this.#at.ys, first, end);
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
    for (let k = this.#at.first + begin + 1; k < this.#at.end; k += 1) {
      if (this.#at.begins[k]) {
        last = null;
        continue;
      }
      const [speed_mps = Number.NaN, off_m = Number.NaN] = [
        this.#at.speed_mps[k],
        this.#at.off_m[k],
      ];
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
