// A screen that goes dark hides what the robot does, and STOP with it: while it is armed the screen
// stays on. The browser drops that whenever the page is hidden, and may drop it to save the battery:
// it is asked for again. Where it is not allowed (plain http, an empty battery) nothing happens.

const AGAIN_MS = 10_000;

export class Awake {
  #wanted = false;
  #asking = false;
  #lock: WakeLockSentinel | null = null;
  #again: ReturnType<typeof setTimeout> | undefined;

  constructor() {
    document.addEventListener('visibilitychange', () => void this.#settle());
  }

  keep(wanted: boolean): void {
    this.#wanted = wanted;
    void this.#settle();
  }

  async #settle(): Promise<void> {
    if (this.#asking) return;
    clearTimeout(this.#again);
    if (!this.#wanted) {
      const lock = this.#lock;
      this.#lock = null;
      await lock?.release();
      return;
    }
    if (!('wakeLock' in navigator)) return;
    this.#again = setTimeout(() => void this.#settle(), AGAIN_MS);
    if (document.visibilityState !== 'visible' || this.#lock?.released === false) return;
    this.#asking = true;
    try {
      this.#lock = await navigator.wakeLock.request('screen');
    } catch {
      this.#lock = null; // not allowed now
    } finally {
      this.#asking = false;
    }
    if (!this.#wanted) await this.#settle(); // disarmed meanwhile
  }
}
