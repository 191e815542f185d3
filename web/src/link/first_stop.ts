// The stop button that stands in the document itself: it stops before the page's program is here. It
// has no words of its own, for the language is not known yet.

const STOP = '/api/v1/vehicle/estop';
/** A try that was not answered by then is given up for the next one. */
const LIMIT_MS = 1500;
const AGAIN_MS = 300;

type State = 'unpressed' | 'trying' | 'stopped';
const SAID: Readonly<Record<State, string>> = {
  unpressed: 'STOP',
  trying: 'STOP …',
  stopped: 'STOP ✓',
};

/** @return the robot has taken it */
const asked = async (): Promise<boolean> => {
  const signal = AbortSignal.timeout(LIMIT_MS);
  const answer = await fetch(STOP, { method: 'POST', cache: 'no-store', signal }).catch(() => null);
  return answer?.ok ?? false;
};

class FirstStop {
  #state: State = 'unpressed';
  #button: HTMLElement | null = null;
  #over = false;

  /** On the press, as the button that comes after it. */
  listen(button: HTMLElement | null): void {
    this.#button = button;
    button?.addEventListener('pointerdown', () => void this.#press());
    button?.addEventListener('click', ({ detail }) => {
      if (detail === 0) void this.#press();
    });
    window.addEventListener('keydown', this.#key, { capture: true });
  }

  /** The page has its own stop button from now on.
   * @param go_on presses it, where the robot has not confirmed yet; null: it goes on trying here */
  hand_over(go_on: (() => void) | null): void {
    window.removeEventListener('keydown', this.#key, { capture: true });
    this.#button = null;
    if (go_on === null || this.#state !== 'trying') return;
    this.#over = true;
    go_on();
  }

  /** The keys that always stop (ui/keys.ts); there is no field yet in which to type. */
  readonly #key = (event: KeyboardEvent): void => {
    const { key, ctrlKey, metaKey, repeat } = event;
    if (key !== ' ' && key !== 'F8' && !(key === 'Enter' && (ctrlKey || metaKey))) return;
    event.preventDefault();
    if (!repeat) void this.#press();
  };

  /** Every press sends at once; one series of tries goes on until one is answered. */
  async #press(): Promise<void> {
    const begun = this.#state === 'trying';
    this.#say('trying');
    let taken = await asked();
    while (!taken && !begun && !this.#over) {
      await new Promise((done) => setTimeout(done, AGAIN_MS));
      taken = await asked();
    }
    if (taken) this.#say('stopped');
  }

  #say(state: State): void {
    this.#state = state;
    if (!this.#button) return;
    this.#button.textContent = SAID[state];
    this.#button.dataset['state'] = state;
  }
}

export const first_stop = new FirstStop();
