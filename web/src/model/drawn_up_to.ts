// Up to which item the route is drawn as done. All of the picture is drawn again for it: where points lie
// close, some seconds later for several of them at once.

const AT_MOST_EVERY_MS = 10_000;

export class DrawnUpTo {
  #begun = 0;
  #item = 0;
  #at_ms = -Infinity;

  /** As far as it is being drawn. */
  get begun(): number {
    return this.#begun;
  }

  /** As far as it is seen. */
  get item(): number {
    return this.#item;
  }

  /** From now on it is drawn so far. @param item from 1; 0: none is driven to */
  begin(item: number): void {
    this.#begun = item;
  }

  /** What was begun is seen. */
  keep(now_ms: number): void {
    this.#item = this.#begun;
    this.#at_ms = now_ms;
  }

  /** Going on may wait; a begin, an end and a way back are shown at once. */
  is_behind(item: number, now_ms: number): boolean {
    if (item === this.#item) return false;
    const goes_on = this.#item > 0 && item > this.#item;
    return !goes_on || now_ms - this.#at_ms >= AT_MOST_EVERY_MS;
  }
}
