import { expect, test } from 'vitest';

import {
  device_name,
  plain_devices,
  why_no_control,
  driver_name,
  present_lines,
  seat_of,
  seat_words,
  told_of,
  type ControlState,
  type Driver,
} from '../src/model/control';

const anna: Driver = { id: 's1', user: 'anna', name: 'tablet', kind: 'browser' };
const ben: Driver = { id: 's2', user: 'ben', name: 'phone', kind: 'browser' };
const script: Driver = { id: 's1', user: 'anna', name: 'rows', kind: 'script' };

const held = (holder: Driver | null, asks: readonly Driver[] = []): ControlState => ({
  on: true,
  holder,
  requests: asks.map((one, index) => ({ ...one, request: index + 1, expires_in_s: 30 })),
});

test('a browser is the holder, or asks, or another one holds it', () => {
  expect(seat_of(held(null), 's1')).toBe('free');
  expect(seat_of(held(anna), 's1')).toBe('mine');
  expect(seat_of(held(anna), 's2')).toBe('others');
  expect(seat_of(held(anna, [ben]), 's2')).toBe('asked');
  // The id of a token is never that of a session.
  expect(seat_of(held(script), 's1')).toBe('others');
});

test('the header says who has control', () => {
  expect(seat_words(held(null), 's1')).toBe('Nobody has control');
  expect(seat_words(held(anna), 's1')).toBe('You have control');
  expect(seat_words(held(ben), 's1')).toBe('ben (phone) has control');
  expect(driver_name(script)).toBe('anna (script rows)');
});

test('a browser in a sentence of the robot is told by its machine', () => {
  const ben =
    'ben (Mozilla/5.0 (Linux; Android 14; Pixel 8) AppleWebKit/537.36 (KHTML, like Gecko))';
  expect(plain_devices(`${ben} took control by force from anna (laptop): the dog is out`)).toBe(
    'ben (Android) took control by force from anna (laptop): the dog is out',
  );
  expect(plain_devices(`${ben} handed control over to ${ben}`)).toBe(
    'ben (Android) handed control over to ben (Android)',
  );
  expect(plain_devices('nobody has control')).toBe('nobody has control');
  expect(plain_devices('ben (Mozilla/5.0 (Linux; cut')).toBe('ben (Linux)');
});

test('of a browser that calls itself a long name the machine is shown', () => {
  expect(device_name('Mozilla/5.0 (X11; Linux x86_64) AppleWebKit/537.36')).toBe('Linux');
  expect(device_name('Mozilla/5.0 (Linux; Android 14; Pixel 8) Chrome')).toBe('Android');
  expect(device_name('Pixel (mine)')).toBe('Pixel (mine)');
});

test('who loses control, or hears no yes, is told why', () => {
  const change = (what: string, from: Driver | null, to: Driver | null): ControlState => ({
    ...held(to),
    change: { what, from, to, detail: `${what}!` },
  });
  expect(told_of(change('forced', anna, ben), 's1')).toBe('forced!');
  expect(told_of(change('forced', anna, ben), 's2')).toBe('');
  expect(told_of(change('refused', anna, ben), 's2')).toBe('refused!');
  expect(told_of(change('expired', anna, ben), 's2')).toBe('expired!');
  expect(told_of(change('refused', anna, ben), 's1')).toBe('');
  expect(told_of(change('taken', null, anna), 's1')).toBe('');
  expect(told_of(held(anna), 's1')).toBe('');
});

test('who is connected is told with the role, the one who has control first', () => {
  const state: ControlState = {
    ...held(ben),
    here: [
      { ...anna, role: 'viewer', streams: 2 },
      { ...script, role: 'admin', streams: 1 },
      { ...ben, role: 'operator', streams: 1 },
    ],
  };
  const lines = present_lines(state, 's1').map(({ words }) => words);
  expect(lines[0]).toMatch(/^ben \(phone\), .*, has control$/);
  expect(lines[1]).toMatch(/^anna \(tablet\), .*, that is you$/);
  // Its id is that of a token: no session has it.
  expect(lines[2]).toMatch(/^anna \(.*rows.*\), /);
  expect(lines[2]).not.toContain('that is you');
  expect(present_lines(held(null), 's1')).toEqual([]);
});

test('who has no control is told why, and what to do', () => {
  const ben = { id: 'b', user: 'ben', name: 'laptop', kind: 'browser' } as const;
  const free = { on: true, holder: null, requests: [] };
  expect(why_no_control('mine', true, { ...free, holder: ben })).toBeNull();
  expect(why_no_control('free', true, free)).toBe('Nobody has control: take it first.');
  expect(why_no_control('others', true, { ...free, holder: ben })).toBe(
    'ben (laptop) has control: ask for it first.',
  );
  expect(why_no_control('free', false, free)).toBe('You watch, and may stop.');
});
