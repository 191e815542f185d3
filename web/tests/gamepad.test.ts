import { describe, expect, test } from 'vitest';

import {
  PAD_DEFAULTS,
  PadHand,
  as_at_first,
  assigned,
  axis_name,
  button_name,
  moved_part,
  pad_kind,
  pad_settings_of,
  pad_words,
  pad_wish,
  speed_hand,
  use_of,
  why_no_hand,
  why_not_pad,
  type PadReading,
} from '../src/model/gamepad';

const limits = { max_speed_mps: 2, max_yaw_rate_dps: 90 };
const pad = (axes: readonly number[], down: readonly number[] = []): PadReading => ({
  id: 'Xbox 360 Controller (STANDARD GAMEPAD Vendor: 045e Product: 028e)',
  mapping: 'standard',
  axes,
  buttons: Array.from({ length: 17 }, (_, k) => ({ pressed: down.includes(k) })),
});
const STILL = [0, 0, 0, 0];
const usual = use_of(PAD_DEFAULTS, 'standard');

describe('which gamepad it is', () => {
  test('by what the browser ordered, else by its name', () => {
    const kind = (id: string, mapping = '') => pad_kind({ id, mapping });
    expect(kind('Anything', 'standard')).toBe('standard');
    expect(kind('046d-c219-Logitech Logitech Cordless RumblePad 2')).toBe('f710_d');
    expect(kind('046d-c21f-Logitech Gamepad F710')).toBe('xpad');
    expect(kind('045e-028e-Microsoft X-Box 360 pad')).toBe('xpad');
    expect(kind('1234-5678-Joystick')).toBe('other');
  });

  test('its buttons are called as printed; the D mode counts from X', () => {
    expect(button_name('standard', 0)).toBe('A');
    expect(button_name('f710_d', 0)).toBe('X');
    expect(button_name('xpad', 6)).toBe('Back');
    expect(button_name('other', 6)).toBe('Button 7');
    expect(axis_name('xpad', 3)).toBe('Right stick, across');
    expect(axis_name('standard', 2)).toBe('Right stick, across');
    expect(axis_name('other', 0)).toBe('Axis 1');
  });
});

describe('what its sticks mean', () => {
  test('up is forwards, right is clockwise, and the share limits both', () => {
    expect(pad_wish(pad([0, -1, 0, 0]), usual, 0, limits, 0.5).speed_mps).toBeCloseTo(1);
    expect(pad_wish(pad([0, 0, 1, 0]), usual, 0, limits, 0.5).yaw_rate_dps).toBeCloseTo(-45);
  });

  test('a thumb that rests moves nothing, and neither does nonsense', () => {
    const still = { speed_mps: 0, yaw_rate_dps: 0 };
    expect(pad_wish(pad([0, 0.1, -0.1, 0]), usual, 0.4, limits, 1)).toEqual(still);
    expect(pad_wish(pad([0, NaN]), usual, 0.4, limits, 1)).toEqual(still);
    expect(pad_wish(pad([0, -7, 0, 0]), usual, 0.4, limits, 1).speed_mps).toBeCloseTo(2);
  });

  test('expo is fine about the middle and leaves the end as it is', () => {
    const half = -(0.12 + 0.88 / 2);
    const speed = (expo: number, up: number) =>
      pad_wish(pad([0, up, 0, 0]), usual, expo, limits, 1).speed_mps;
    expect(speed(0, half)).toBeCloseTo(1);
    expect(speed(1, half)).toBeCloseTo(0.25); // 2 · 0.5³
    expect(speed(1, -1)).toBeCloseTo(2);
  });
});

describe('the dead-man', () => {
  const take = (hand: PadHand, down: readonly number[] | null, bumpers = false, at_ms = 0) =>
    hand.take(down && pad(STILL, down), usual, bumpers, at_ms);

  test('begins with a fresh press only, and ends when it is let go', () => {
    const hand = new PadHand();
    expect(take(hand, [4])).toBeNull(); // down when it is seen first
    expect(take(hand, [])).toBeNull();
    expect(take(hand, [4])).toBe('grab');
    expect(take(hand, [4])).toBeNull();
    expect(take(hand, [])).toBe('let_go');
    expect(take(hand, [])).toBeNull();
  });

  test('pulled out it is let go at once, and begins nothing when it is back', () => {
    const hand = new PadHand();
    take(hand, []);
    expect(take(hand, [4])).toBe('grab');
    expect(take(hand, null)).toBe('let_go');
    expect(take(hand, [4])).toBeNull();
    take(hand, []);
    expect(take(hand, [4])).toBe('grab');
    expect(hand.lose_sight()).toBe('let_go');
    expect(hand.lose_sight()).toBeNull();
  });

  test('both bumpers, held together, ask once for driving by hand, if that is chosen', () => {
    const hand = new PadHand();
    take(hand, [], true);
    expect(take(hand, [4, 5], true, 0)).toBe('grab');
    expect(take(hand, [4, 5], true, 400)).toBeNull();
    expect(take(hand, [4, 5], true, 500)).toBe('by_hand');
    expect(take(hand, [4, 5], true, 2000)).toBeNull();
    expect(take(hand, [4], true, 2100)).toBeNull();
    expect(take(hand, [4, 5], true, 2200)).toBeNull();
    expect(take(hand, [4, 5], true, 2700)).toBe('by_hand');
    const without = new PadHand();
    take(without, []);
    take(without, [4, 5], false, 0);
    expect(take(without, [4, 5], false, 900)).toBeNull();
  });
});

describe('what is chosen', () => {
  test('buttons are assigned by pressing them, sticks by pushing them', () => {
    expect(moved_part(pad(STILL, [1]), pad(STILL, [1, 6]), 'hold', 'standard')).toBe(6);
    expect(moved_part(pad(STILL), pad([0, 0, 0, -0.9]), 'speed', 'standard')).toBe(3);
    expect(moved_part(pad(STILL), pad([0.3, 0, 0, 0]), 'speed', 'standard')).toBeNull();
    const settings = assigned(PAD_DEFAULTS, 'standard', 'hold', 6);
    expect(use_of(settings, 'standard')).toMatchObject({ speed: 1, turn: 2, hold: 6, other: 5 });
    expect(use_of(settings, 'xpad').hold).toBe(4);
  });

  test('what a button was before goes to what had the new one: none means two things', () => {
    const settings = assigned(PAD_DEFAULTS, 'standard', 'hold', 5);
    expect(use_of(settings, 'standard')).toMatchObject({ hold: 5, other: 4 });
    const turned = assigned(settings, 'standard', 'turn', 1);
    expect(use_of(turned, 'standard')).toMatchObject({ speed: 2, turn: 1, hold: 5, other: 4 });
    // Axis 5 and button 5 of this one are two things; and no stick is a trigger, which rests at its end.
    const trigger = use_of(assigned(PAD_DEFAULTS, 'xpad', 'trigger', 3), 'xpad');
    expect(trigger).toEqual({ speed: 1, turn: null, hold: 4, other: 5, trigger: 3 });
    expect(why_not_pad(trigger)).toContain('assign');
    expect(use_of(assigned(PAD_DEFAULTS, 'xpad', 'turn', 5), 'xpad').trigger).toBeNull();
    expect(use_of(as_at_first(turned, 'standard'), 'standard')).toEqual(usual);
  });

  test('one that nobody knows drives only once it is assigned', () => {
    const none = use_of(PAD_DEFAULTS, 'other');
    expect(why_not_pad(none)).toContain('assign');
    const hand = new PadHand();
    hand.take(pad(STILL), none, false, 0);
    expect(hand.take(pad(STILL, [0, 1, 2, 3, 4, 5]), none, false, 1)).toBeNull();
  });

  test('what is kept comes back; what nobody wrote like that is as at first', () => {
    const settings = { ...assigned(PAD_DEFAULTS, 'f710_d', 'turn', 0), expo: 0.7, bumpers: true };
    expect(pad_settings_of(JSON.parse(JSON.stringify(settings)))).toEqual(settings);
    expect(pad_settings_of(undefined)).toEqual(PAD_DEFAULTS);
    expect(pad_settings_of({ uses: 3, expo: 9, bumpers: 'yes' })).toEqual(PAD_DEFAULTS);
    expect(pad_settings_of({ uses: { xpad: { hold: -1, speed: 1.5 } } }).uses.xpad).toEqual({
      speed: null,
      turn: null,
      hold: null,
      other: null,
      trigger: 5, // kept before there was one
    });
  });
});

describe('what is said of it', () => {
  const facts = {
    there: true,
    why_not: null,
    hold_name: 'LB',
    by_hand: false,
    not_yet: null,
    auto_share: null,
    wants_hand: false,
    auto_drives: false,
    bumpers: false,
    no_manual: null,
  };

  test('is nothing without one, unless AUTO wants a hand on one', () => {
    expect(pad_words({ ...facts, there: false })).toBeNull();
    expect(pad_words({ ...facts, there: false, wants_hand: true })).toContain('none is there');
  });

  test('by hand it is what to hold, or why the robot does not take the stick yet', () => {
    const by_hand = { ...facts, by_hand: true };
    expect(pad_words(by_hand)).toBe('Gamepad: hold LB to drive.');
    expect(pad_words({ ...by_hand, not_yet: 'let the stick go once' })).toBe(
      'Gamepad: let the stick go once',
    );
  });

  test('in AUTO it does not claim a hand that is not there', () => {
    const auto = { ...facts, wants_hand: true };
    expect(pad_words(auto)).toContain('draw the trigger for AUTO');
    expect(pad_words({ ...auto, auto_drives: true })).toContain('drives without your hand');
    expect(pad_words({ ...auto, auto_drives: true, auto_share: 0.5 })).toBe(
      'Gamepad: AUTO at 50 %; let go to hold.',
    );
  });

  test('bumpers are offered where they choose MANUAL, else why they do not', () => {
    expect(pad_words({ ...facts, bumpers: true })).toContain('hold both bumpers');
    expect(pad_words({ ...facts, bumpers: true, no_manual: 'Arm the robot first.' })).toBe(
      'Gamepad: Arm the robot first.',
    );
  });
});

describe('a hand on the speed of AUTO', () => {
  const drawn = (value: number, down: readonly number[]): PadReading => ({
    ...pad(STILL, down),
    buttons: pad(STILL, down).buttons.map((button, k) => (k === 7 ? { ...button, value } : button)),
  });
  const hand = (reading: PadReading | null) => speed_hand(reading, usual, 'standard');

  test('is either bumper, with the trigger as its share', () => {
    expect(hand(drawn(0.6, [4]))).toEqual({ held: true, share: 0.6 });
    expect(hand(drawn(0.25, [5]))).toEqual({ held: true, share: 0.25 });
    expect(hand(drawn(0.9, []))).toEqual({ held: false, share: 0 });
    expect(hand(drawn(NaN, [4]))).toEqual({ held: true, share: 0 });
    expect(hand(null)).toEqual({ held: false, share: 0 });
  });

  test('with a trigger that is a mere button is all or nothing', () => {
    const digital = use_of(PAD_DEFAULTS, 'f710_d');
    expect(speed_hand(pad(STILL, [4]), digital, 'f710_d').share).toBe(0);
    expect(speed_hand(pad(STILL, [4, 7]), digital, 'f710_d').share).toBe(1);
  });

  test('with a trigger that is an axis is nothing until it was touched', () => {
    const use = use_of(PAD_DEFAULTS, 'xpad');
    const share = (at: number) => speed_hand(pad([0, 0, 0, 0, 0, at], [4]), use, 'xpad').share;
    expect([0, -1, 1, 0.5].map(share)).toEqual([0, 0, 1, 0.75]);
  });

  test('is asked for only where that was chosen', () => {
    const free = { held: false, share: 0 };
    expect(why_no_hand(false, false, free)).toBeNull();
    expect(why_no_hand(true, true, free)).toMatch(/^Hold a bumper/);
    expect(why_no_hand(true, false, free)).toMatch(/none is there/);
    expect(why_no_hand(true, true, { held: true, share: 0 })).toBeNull();
  });
});
