import { describe, expect, it, test } from 'vitest';

import { Grip, thumb_at } from '../src/model/drive';

describe('a grip on the drive pad', () => {
  it('is fresh when a finger or a key comes down on nothing', () => {
    expect(new Grip().finger_down()).toBe(true);
    expect(new Grip().key_down('w', false)).toBe(true);
  });

  it('is not fresh while something is down already', () => {
    const grip = new Grip();
    grip.finger_down();
    expect(grip.key_down('w', false)).toBe(false);
    grip.finger_up();
    expect(grip.free).toBe(false);
    expect(grip.key_down('a', false)).toBe(false);
    expect(grip.finger_down()).toBe(false);
  });

  it('is not fresh when the keyboard repeats a key whose first press nobody saw', () => {
    const grip = new Grip();
    grip.key_down('w', false);
    grip.lose_sight(); // the window lost the focus: its end will not be told
    expect(grip.free).toBe(true);
    expect(grip.key_down('w', true)).toBe(false);
    expect(grip.free).toBe(false);
    expect(grip.key_down('d', false)).toBe(false);
    grip.key_up('w');
    grip.key_up('d');
    expect(grip.key_down('w', false)).toBe(true);
  });

  it('is fresh after the pad went under a finger or a key, but not while a gamepad is held', () => {
    const grip = new Grip();
    grip.finger_down();
    grip.key_down('w', false);
    grip.lose_pad();
    expect(grip.finger_down()).toBe(true);

    grip.lose_pad();
    expect(grip.key_down('w', true)).toBe(false); // held all the while
    grip.lose_pad();
    expect(grip.gamepad_down()).toBe(true);
    grip.lose_pad();
    expect(grip.finger_down()).toBe(false);
  });

  it('is free again only when all is up', () => {
    const grip = new Grip();
    grip.key_down('w', false);
    grip.key_down('a', false);
    expect([...grip.keys]).toEqual(['w', 'a']);
    grip.key_up('w');
    expect(grip.free).toBe(false);
    grip.key_up('a');
    expect(grip.free).toBe(true);
  });
});

test('a thumb is told from the middle of the pad as it lay when the thumb came, and not beyond its edge', () => {
  const pad = { left: 100, top: 400, width: 200, height: 100 };
  expect(thumb_at(200, 450, pad)).toEqual({ right: 0, up: 0 });
  expect(thumb_at(250, 425, pad)).toEqual({ right: 0.5, up: 0.5 });
  expect(thumb_at(999, 0, pad)).toEqual({ right: 1, up: 1 });
  expect(thumb_at(0, 999, pad)).toEqual({ right: -1, up: -1 });
});
