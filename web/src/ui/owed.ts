// A save that nobody answered: it is tried again by itself, as soon as somebody may answer.

const AGAIN_AFTER_MS = 5000;

export class Owed {
  #is = false;
  #timer: ReturnType<typeof setTimeout> | undefined;
  readonly #again: () => void;

  constructor(again: () => void) {
    this.#again = again;
  }

  get is(): boolean {
    return this.#is;
  }

  /** @return it was not so before */
  set(owed: boolean): boolean {
    const changed = owed !== this.#is;
    this.#is = owed;
    clearTimeout(this.#timer);
    if (owed) this.#timer = setTimeout(this.#again, AGAIN_AFTER_MS);
    return changed;
  }
}
