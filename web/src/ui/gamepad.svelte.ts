// The gamepad of this device: looked at often while the page is seen, and told what became of it.

import {
  NO_HAND,
  PadHand,
  pad_kind,
  speed_hand,
  use_of,
  why_not_pad,
  type PadDeed,
  type PadKind,
  type PadReading,
  type PadUse,
  type SpeedHand,
} from '../model/gamepad';
import { device } from './device.svelte';

/** Browsers tell of buttons only when they are asked; of a gamepad that comes they tell themselves. */
const LOOK_MS = 20;
const SEEK_MS = 500;

/** The one that is used: the first that is there. */
const read = (): PadReading | null => {
  if (document.visibilityState !== 'visible' || !('getGamepads' in navigator)) return null;
  return navigator.getGamepads().find((each) => each?.connected) ?? null;
};

/** What moves is copied: some browsers change what they gave out before. */
const copy = ({ id, mapping, axes, buttons }: PadReading): PadReading => ({
  id,
  mapping,
  axes: [...axes],
  buttons: buttons.map(({ pressed, value }) => ({
    pressed,
    ...(value === undefined ? {} : { value }),
  })),
});

export class Gamepads {
  /** Null: none is there, or nobody has pressed a button of it yet. */
  reading = $state.raw<PadReading | null>(null);
  kind = $derived<PadKind>(this.reading ? pad_kind(this.reading) : 'other');
  use = $derived<PadUse>(use_of(device.settings.gamepad, this.kind));
  why_not = $derived<string | null>(why_not_pad(this.use));
  /** On the speed of AUTO. */
  hand = $state.raw<SpeedHand>(NO_HAND);
  /** While its buttons are assigned it does not drive. */
  assigns = $state(false);

  readonly #hand = new PadHand();
  readonly #deed: (deed: PadDeed) => void;
  readonly #gone: () => void;

  /** @param deed told what the hands do, at once @param gone told when one in hand is pulled out */
  constructor(deed: (deed: PadDeed) => void, gone: () => void) {
    this.#deed = deed;
    this.#gone = gone;
  }

  /** @return ends it */
  watch(): () => void {
    let timer: ReturnType<typeof setTimeout>;
    const look = (): void => {
      clearTimeout(timer);
      this.#look();
      timer = setTimeout(look, this.reading === null ? SEEK_MS : LOOK_MS);
    };
    timer = setTimeout(look, LOOK_MS); // not at once: who calls this does not wait for what is read
    window.addEventListener('gamepadconnected', look);
    window.addEventListener('gamepaddisconnected', look);
    return () => {
      clearTimeout(timer);
      window.removeEventListener('gamepadconnected', look);
      window.removeEventListener('gamepaddisconnected', look);
      this.lose_sight();
    };
  }

  lose_sight(): void {
    this.#take_hand(NO_HAND);
    this.#tell(this.#hand.lose_sight());
  }

  #look(): void {
    const found = read();
    if (found === null && this.reading === null) return;
    const pulled = found === null && document.visibilityState === 'visible';
    const in_hand = this.hand.held || this.#hand.held;
    this.reading = found && copy(found);
    if (pulled && in_hand) this.#gone();
    const given = this.assigns ? null : this.reading;
    const { bumpers } = device.settings.gamepad;
    this.#take_hand(speed_hand(given, this.use, this.kind));
    this.#tell(this.#hand.take(given, this.use, bumpers, performance.now()));
  }

  #take_hand(hand: SpeedHand): void {
    const same = hand.held === this.hand.held && hand.share === this.hand.share;
    if (!same) this.hand = hand;
  }

  #tell(deed: PadDeed | null): void {
    if (deed !== null) this.#deed(deed);
  }
}
