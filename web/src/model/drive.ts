// From a finger on the drive pad to a command.

export interface DriveLimits {
  readonly max_speed_mps: number;
  readonly max_yaw_rate_dps: number;
}
export interface DriveWish {
  readonly speed_mps: number;
  /** Counter-clockwise (to the left) positive. */
  readonly yaw_rate_dps: number;
}

/** Teleoperation over the live stream. @param past the hand also holds the guard off, to creep past
 * what stands there. @return false: not connected, nothing was sent */
export type SendDrive = (
  speed_mps: number,
  yaw_rate_dps: number,
  deadman: boolean,
  past?: boolean,
) => boolean;

/** A hand on the speed of AUTO. @return as SendDrive */
export type SendThrottle = (share: number, held: boolean) => boolean;

/** Commands go out every 80 ms while held: above 10 Hz even when the browser is late. */
export const DRIVE_PERIOD_MS = 80;
/** Share of the pad around its middle that means zero: a thumb is never quite still. */
export const DEAD_ZONE = 0.12;

/** @param expo 0: straight; 1: fine about the middle, steep at the end */
export const shaped = (value: number, expo = 0): number => {
  const size = Math.min(Math.abs(value), 1);
  if (size <= DEAD_ZONE) return 0;
  const over = (size - DEAD_ZONE) / (1 - DEAD_ZONE);
  return Math.sign(value) * ((1 - expo) * over + expo * over ** 3);
};

/** Where a thumb is on the pad, from its middle: 1 is its edge. */
export const thumb_at = (
  x_px: number,
  y_px: number,
  box: Readonly<Record<'left' | 'top' | 'width' | 'height', number>>,
): { right: number; up: number } => {
  const within = (value: number): number => Math.max(-1, Math.min(1, value));
  return {
    right: within(((x_px - box.left) / box.width) * 2 - 1),
    up: within(1 - ((y_px - box.top) / box.height) * 2),
  };
};

/**
 * @param right, up place of the finger from the middle of the pad, each in [-1, 1]
 * @param share 0..1 of the vehicle's limits, from the speed setting
 * @param expo as shaped()
 */
export const drive_wish = (
  right: number,
  up: number,
  limits: DriveLimits,
  share: number,
  expo = 0,
): DriveWish => ({
  speed_mps: shaped(up, expo) * limits.max_speed_mps * share,
  yaw_rate_dps: 0 - shaped(right, expo) * limits.max_yaw_rate_dps * share,
});

/** While nobody pushes the pad says so: the robot obeys only who was seen to let go before. */
export const LET_GO_PERIOD_MS = 250;

/**
 * What is pressed, whether it drives or not. Only a fresh grip begins to drive: a finger or a key that
 * is down already, or a key that the keyboard repeats, begins nothing. A gamepad tells itself what is
 * fresh (gamepad.ts).
 */
export class Grip {
  #finger = false;
  #gamepad = false;
  readonly #keys = new Set<string>();

  get keys(): ReadonlySet<string> {
    return this.#keys;
  }
  get free(): boolean {
    return !this.#finger && !this.#gamepad && this.#keys.size === 0;
  }

  /** @return true: a fresh grip */
  finger_down(): boolean {
    const fresh = this.free;
    this.#finger = true;
    return fresh;
  }
  finger_up(): void {
    this.#finger = false;
  }
  /** @return true: nothing else is pressed */
  gamepad_down(): boolean {
    const fresh = this.free;
    this.#gamepad = true;
    return fresh;
  }
  gamepad_up(): void {
    this.#gamepad = false;
  }
  /** @return true: a fresh grip */
  key_down(key: string, repeated: boolean): boolean {
    const fresh = this.free && !repeated;
    this.#keys.add(key);
    return fresh;
  }
  key_up(key: string): void {
    this.#keys.delete(key);
  }
  /** The pad is gone from the page: of a finger and of keys it hears no more. A gamepad tells itself. */
  lose_pad(): void {
    this.#finger = false;
    this.#keys.clear();
  }
  /** The page does not hear any more when something is let go. */
  lose_sight(): void {
    this.lose_pad();
    this.#gamepad = false;
  }
}

/** The same from keys held down; opposite keys cancel. */
export const wish_of_keys = (
  held: ReadonlySet<string>,
  limits: DriveLimits,
  share: number,
): DriveWish => {
  const on = (...keys: string[]): number => (keys.some((key) => held.has(key)) ? 1 : 0);
  const up = on('ArrowUp', 'w') - on('ArrowDown', 's');
  const right = on('ArrowRight', 'd') - on('ArrowLeft', 'a');
  return drive_wish(right, up, limits, share);
};
