// Up to which item the route is drawn as done. All of the picture is drawn again for it: where points lie
// close, some seconds later for several of them at once.

const AT_MOST_EVERY_MS = 10_000;

export class DrawnUpTo {
  #item = 0;
  #at_ms = -Infinity;

  /** As far as it is drawn. */
  get item(): number {
    return this.#item;
  }

  /** Drawn now. @param item from 1; 0: none is driven to */
  keep(item: number, now_ms: number): void {
    this.#item = item;
    this.#at_ms = now_ms;
  }

  /** Going on may wait; a begin, an end and a way back are shown at once. */
  is_behind(item: number, now_ms: number): boolean {
    if (item === this.#item) return false;
    const goes_on = this.#item > 0 && item > this.#item;
    return !goes_on || now_ms - this.#at_ms >= AT_MOST_EVERY_MS;
  }
}
