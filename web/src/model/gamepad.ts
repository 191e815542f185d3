// A gamepad as the browser reports it, and what its sticks and buttons mean. It drives only while its
// dead-man button is held; pulled out, or silent, it is let go.

import { shaped, type DriveLimits, type DriveWish } from './drive';
import { say } from './say';

/** Of what the browser tells about a gamepad. */
export interface PadReading {
  readonly id: string;
  readonly mapping: string;
  /** Each in [-1, 1]; sticks: right and down positive. */
  readonly axes: readonly number[];
  /** With how far each is pressed, 0 to 1, where it tells. */
  readonly buttons: readonly { readonly pressed: boolean; readonly value?: number }[];
}

/** Whose buttons stand where: as the browser orders them itself; the F710 with its switch at D; the
 * Xbox's, and the F710's at X, as Linux numbers them; one that nobody knows. */
export type PadKind = 'standard' | 'f710_d' | 'xpad' | 'other';
export const PAD_KINDS: readonly PadKind[] = ['standard', 'f710_d', 'xpad', 'other'];

export const pad_kind = ({ id, mapping }: Pick<PadReading, 'id' | 'mapping'>): PadKind => {
  if (mapping === 'standard') return 'standard';
  if (/c219|rumblepad 2/i.test(id)) return 'f710_d';
  return /c21f|045e|x-?box|f710/i.test(id) ? 'xpad' : 'other';
};

/** Numbers of axes and buttons; null: nobody has said. */
export interface PadUse {
  /** Pushed away from the driver: forwards. */
  readonly speed: number | null;
  readonly turn: number | null;
  /** The dead-man button. */
  readonly hold: number | null;
  /** Held together with that one: by hand from now on. */
  readonly other: number | null;
  /** How fast AUTO may drive; a button, or an axis (trigger_is_axis). */
  readonly trigger: number | null;
}
export type PadPart = keyof PadUse;
export const PAD_PARTS: readonly PadPart[] = ['speed', 'turn', 'hold', 'other', 'trigger'];
/** Linux counts the Xbox's triggers among the axes. */
const trigger_is_axis = (kind: PadKind): boolean => kind === 'xpad';
export const is_axis = (part: PadPart, kind: PadKind): boolean =>
  part === 'speed' || part === 'turn' || (part === 'trigger' && trigger_is_axis(kind));

/** Left stick: speed; right one: steering; the bumpers are the safety buttons. */
const USUAL: Readonly<Record<PadKind, PadUse>> = {
  standard: { speed: 1, turn: 2, hold: 4, other: 5, trigger: 7 },
  f710_d: { speed: 1, turn: 2, hold: 4, other: 5, trigger: 7 },
  xpad: { speed: 1, turn: 3, hold: 4, other: 5, trigger: 5 },
  other: { speed: null, turn: null, hold: null, other: null, trigger: null },
};

export interface PadSettings {
  readonly uses: Readonly<Partial<Record<PadKind, PadUse>>>;
  /** 0: straight; 1: fine about the middle, steep at the end. */
  readonly expo: number;
  /** Both bumpers together choose the mode MANUAL. */
  readonly bumpers: boolean;
  /** AUTO drives only while a bumper is held, as fast as the trigger is drawn. */
  readonly auto: boolean;
}
export const PAD_DEFAULTS: PadSettings = { uses: {}, expo: 0.4, bumpers: false, auto: false };

export const use_of = (settings: PadSettings, kind: PadKind): PadUse =>
  settings.uses[kind] ?? USUAL[kind];

/** What had that number gets the one that was before: one button never means two things. But a trigger
 * that is an axis rests at its end, and a stick in its middle: neither is given for the other. */
export const assigned = (
  settings: PadSettings,
  kind: PadKind,
  part: PadPart,
  number: number,
): PadSettings => {
  const use = use_of(settings, kind);
  const had = PAD_PARTS.find(
    (each) => use[each] === number && is_axis(each, kind) === is_axis(part, kind),
  );
  const unlike = trigger_is_axis(kind) && (had === 'trigger' || part === 'trigger');
  const given = unlike ? null : use[part];
  const changed = { ...use, ...(had ? { [had]: given } : {}), [part]: number };
  return { ...settings, uses: { ...settings.uses, [kind]: changed } };
};

export const as_at_first = (settings: PadSettings, kind: PadKind): PadSettings => ({
  ...settings,
  uses: Object.fromEntries(Object.entries(settings.uses).filter(([each]) => each !== kind)),
});

const AT_MOST = 64;
const record_of = (value: unknown): Readonly<Record<string, unknown>> =>
  typeof value === 'object' && value !== null ? { ...value } : {};
const number_in = (value: unknown): number | null =>
  typeof value === 'number' && Number.isInteger(value) && value >= 0 && value < AT_MOST
    ? value
    : null;

/** What was kept on the device; what nobody wrote like that is as at first. */
export const pad_settings_of = (kept: unknown): PadSettings => {
  const { uses, expo, bumpers, auto } = record_of(kept);
  const read: Partial<Record<PadKind, PadUse>> = {};
  for (const kind of PAD_KINDS) {
    const use = record_of(uses)[kind];
    if (use === undefined) continue;
    const { speed, turn, hold, other, trigger } = record_of(use);
    read[kind] = {
      speed: number_in(speed),
      turn: number_in(turn),
      hold: number_in(hold),
      other: number_in(other),
      // What was kept before there was one has the usual.
      trigger: trigger === undefined ? USUAL[kind].trigger : number_in(trigger),
    };
  }
  const fits = typeof expo === 'number' && expo >= 0 && expo <= 1;
  return {
    uses: read,
    expo: fits ? expo : PAD_DEFAULTS.expo,
    bumpers: bumpers === true,
    auto: auto === true,
  };
};

const NAMES: Readonly<Record<PadKind, readonly string[]>> = {
  standard: [
    ...['A', 'B', 'X', 'Y', 'LB', 'RB', 'LT', 'RT', 'Back', 'Start', 'LS', 'RS'],
    ...['↑', '↓', '←', '→', 'Logo'],
  ],
  f710_d: ['X', 'A', 'B', 'Y', 'LB', 'RB', 'LT', 'RT', 'Back', 'Start', 'LS', 'RS'],
  xpad: ['A', 'B', 'X', 'Y', 'LB', 'RB', 'Back', 'Start', 'Logo', 'LS', 'RS'],
  other: [],
};
/** As it is printed on it. */
export const button_name = (kind: PadKind, button: number): string =>
  NAMES[kind][button] ?? say('button_button', { button: button + 1 });

const sticks = (): readonly string[] => [say('left_stick_across'), say('left_stick_along')];
const more = (): Readonly<Record<PadKind, readonly string[]>> => ({
  standard: [say('right_stick_across'), say('right_stick_along')],
  f710_d: [say('right_stick_across'), say('right_stick_along')],
  xpad: ['LT', say('right_stick_across'), say('right_stick_along'), 'RT'],
  other: [],
});
export const axis_name = (kind: PadKind, axis: number): string =>
  (kind === 'other' ? [] : [...sticks(), ...more()[kind]])[axis] ??
  say('axis_axis', { axis: axis + 1 });

export const pressed = (reading: PadReading, button: number | null): boolean =>
  button !== null && reading.buttons[button]?.pressed === true;

/** Where a stick stands, in [-1, 1]; 0: it has none, or nothing sensible. */
export const axis_value = (reading: PadReading, axis: number | null): number => {
  const value = axis === null ? 0 : (reading.axes[axis] ?? 0);
  return Number.isFinite(value) ? Math.max(-1, Math.min(1, value)) : 0;
};

/** @param share 0..1 of the vehicle's limits, from the speed setting */
export const pad_wish = (
  reading: PadReading,
  use: PadUse,
  expo: number,
  limits: DriveLimits,
  share: number,
): DriveWish => {
  const of = (axis: number | null): number => shaped(axis_value(reading, axis), expo) * share;
  return {
    speed_mps: 0 - of(use.speed) * limits.max_speed_mps,
    yaw_rate_dps: 0 - of(use.turn) * limits.max_yaw_rate_dps,
  };
};

/** Why it cannot drive; null: it can. */
export const why_not_pad = (use: PadUse): string | null =>
  use.speed === null || use.turn === null || use.hold === null
    ? say('nobody_knows_its_buttons_assign_two')
    : null;

/** What was moved or pressed since `before`, to be assigned. */
export const moved_part = (
  before: PadReading,
  now: PadReading,
  part: PadPart,
  kind: PadKind,
): number | null => {
  const found = is_axis(part, kind)
    ? now.axes.findIndex((_, k) => Math.abs(axis_value(now, k) - axis_value(before, k)) > 0.6)
    : now.buttons.findIndex(({ pressed: on }, k) => on && !pressed(before, k));
  return found < 0 ? null : found;
};

/** A hand on the speed of AUTO. */
export interface SpeedHand {
  readonly held: boolean;
  /** 0..1 of the mission's speed. */
  readonly share: number;
}
export const NO_HAND: SpeedHand = { held: false, share: 0 };

const drawn = (reading: PadReading, trigger: number | null, kind: PadKind): number => {
  if (trigger === null) return 0;
  if (trigger_is_axis(kind)) {
    const value = axis_value(reading, trigger);
    // Until it is touched it tells nothing, which would be half.
    return value === 0 ? 0 : (value + 1) / 2;
  }
  const { pressed: down, value } = reading.buttons[trigger] ?? { pressed: false };
  const share = value ?? (down ? 1 : 0);
  return Number.isFinite(share) ? Math.max(0, Math.min(1, share)) : 0;
};

/** Either bumper is its dead-man. @param reading null: it is gone, or out of sight */
export const speed_hand = (reading: PadReading | null, use: PadUse, kind: PadKind): SpeedHand => {
  const held = reading !== null && (pressed(reading, use.hold) || pressed(reading, use.other));
  return held ? { held, share: drawn(reading, use.trigger, kind) } : NO_HAND;
};

/** Why AUTO may not begin now; null: it may. @param wanted it wants a hand @param there a gamepad is */
export const why_no_hand = (wanted: boolean, there: boolean, hand: SpeedHand): string | null => {
  if (!wanted || hand.held) return null;
  return there
    ? say('hold_a_bumper_of_the_gamepad_it_is')
    : say('auto_wants_a_hand_on_the_gamepad_and');
};

export interface PadFacts {
  readonly there: boolean;
  /** It cannot drive. */
  readonly why_not: string | null;
  /** Of its dead-man. */
  readonly hold_name: string;
  readonly by_hand: boolean;
  /** The robot does not take the stick yet; null: it does. */
  readonly not_yet: string | null;
  /** AUTO is under a hand now, so fast. */
  readonly auto_share: number | null;
  readonly wants_hand: boolean;
  /** A mission drives by itself. */
  readonly auto_drives: boolean;
  readonly bumpers: boolean;
  /** MANUAL cannot be chosen now. */
  readonly no_manual: string | null;
}

/** What the gamepad does, or waits for; null: there is none, and none is wanted. */
export const pad_words = (facts: PadFacts): string | null => {
  const why = (why_not: string): string => say('gamepad_why_not', { why_not });
  if (!facts.there) return facts.wants_hand ? say('gamepad_none_and_auto_wants_one') : null;
  if (facts.why_not !== null) return why(facts.why_not);
  if (facts.by_hand) {
    if (facts.not_yet !== null) return why(facts.not_yet);
    return `${say('gamepad_hold')} ${facts.hold_name} ${say('to_drive_2')}`;
  }
  if (facts.auto_share !== null) {
    const share = Math.round(100 * facts.auto_share);
    return `${say('gamepad_auto_at')} ${share} %${say('let_go_to_hold')}`;
  }
  if (facts.wants_hand) {
    return facts.auto_drives
      ? say('gamepad_auto_drives_without_your_hand')
      : say('gamepad_hold_a_bumper_and_draw_the');
  }
  if (!facts.bumpers) return say('gamepad_is_there');
  return facts.no_manual === null
    ? say('gamepad_hold_both_bumpers_to_drive')
    : why(facts.no_manual);
};

/** So long both bumpers are held: nobody does that by chance. */
export const BUMPERS_MS = 500;

export type PadDeed = 'grab' | 'let_go' | 'by_hand';

/**
 * What the hands do with the buttons, told once each. Only a fresh grip begins: a button that is down
 * when it is seen first, or was out of sight, begins nothing.
 *
 *   Down --up--> Up --down--> Held --up, gone--> Up
 */
export class PadHand {
  #phase: 'down' | 'up' | 'held' = 'down';
  #both_since_ms: number | null = null;
  #asked = false;

  /** It drives by hand. */
  get held(): boolean {
    return this.#phase === 'held';
  }

  /** @param reading null: it is gone; @param now_ms of any clock that only goes on */
  take(reading: PadReading | null, use: PadUse, bumpers: boolean, now_ms: number): PadDeed | null {
    if (reading === null) return this.lose_sight();
    const holds = why_not_pad(use) === null && pressed(reading, use.hold);
    const both = holds && bumpers && use.other !== use.hold && pressed(reading, use.other);
    if (!both) this.#asked = false;
    this.#both_since_ms = both ? (this.#both_since_ms ?? now_ms) : null;
    if (!holds) {
      const held = this.#phase === 'held';
      this.#phase = 'up';
      return held ? 'let_go' : null;
    }
    if (this.#phase === 'up') {
      this.#phase = 'held';
      return 'grab';
    }
    const since_ms = this.#both_since_ms;
    if (since_ms === null || this.#asked || now_ms - since_ms < BUMPERS_MS) return null;
    this.#asked = true;
    return 'by_hand';
  }

  /** It was pulled out, or the page is not looked at. */
  lose_sight(): PadDeed | null {
    const held = this.#phase === 'held';
    this.#phase = 'down';
    this.#both_since_ms = null;
    this.#asked = true;
    return held ? 'let_go' : null;
  }
}
