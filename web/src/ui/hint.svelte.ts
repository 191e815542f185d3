// Why a button does nothing now, told where it was pressed: a finger cannot hover. One at a time.

const SHOWN_MS = 5000;
/** Nearer to the upper edge there is no room above. */
const ROOM_PX = 110;

export interface HintPlace {
  /** Of the button's middle. */
  readonly x_px: number;
  readonly top_px: number;
  readonly bottom_px: number;
  readonly below: boolean;
}

class Hint {
  text = $state<string | null>(null);
  place = $state.raw<HintPlace>({ x_px: 0, top_px: 0, bottom_px: 0, below: false });
  #timer: ReturnType<typeof setTimeout> | undefined;

  show(text: string, button: Element): void {
    const { left, right, top, bottom } = button.getBoundingClientRect();
    this.place = {
      x_px: (left + right) / 2,
      top_px: top,
      bottom_px: bottom,
      below: top < ROOM_PX,
    };
    this.text = text;
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.hide(), SHOWN_MS);
  }

  hide(): void {
    clearTimeout(this.#timer);
    this.text = null;
  }
}

export const hint = new Hint();
