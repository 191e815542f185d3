// A screen that goes dark hides what the robot does, and STOP with it: while it is armed the screen
// stays on. The browser drops that whenever the page is hidden, and where it is not allowed (plain
// http, an empty battery) nothing happens.

export class Awake {
  #wanted = false;
  #asking = false;
  #lock: WakeLockSentinel | null = null;

  constructor() {
    document.addEventListener('visibilitychange', () => void this.#settle());
  }

  keep(wanted: boolean): void {
    this.#wanted = wanted;
    void this.#settle();
  }

  async #settle(): Promise<void> {
    if (this.#asking) return;
    if (!this.#wanted) {
      const lock = this.#lock;
      this.#lock = null;
      await lock?.release();
      return;
    }
    if (document.visibilityState !== 'visible' || this.#lock?.released === false) return;
    if (!('wakeLock' in navigator)) return;
    this.#asking = true;
    try {
      this.#lock = await navigator.wakeLock.request('screen');
    } catch {
      this.#lock = null; // not allowed now: asked again when the page is seen again
    } finally {
      this.#asking = false;
    }
    if (!this.#wanted) await this.#settle(); // disarmed meanwhile
  }
}
