// A button that is held, not tapped: what it does cannot happen by a slip of the thumb.

/** So long it is held. */
export const HOLD_MS = 1000;

export class Hold {
  #began_ms: number | null = null;

  begin(now_ms: number): void {
    this.#began_ms ??= now_ms;
  }
  end(): void {
    this.#began_ms = null;
  }
  get held(): boolean {
    return this.#began_ms !== null;
  }
  /** 0 to 1: now. */
  share(now_ms: number): number {
    if (this.#began_ms === null) return 0;
    return Math.min(1, Math.max(0, now_ms - this.#began_ms) / HOLD_MS);
  }
}
