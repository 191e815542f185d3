import { describe, expect, test } from 'vitest';

import { Pings, RobotClock } from '../src/model/clock';

// The robot's clock stands 1000 s ahead of the page's in all of these.
const AHEAD_S = 1000;

describe('the robot’s clock', () => {
  test('is not known before a round trip, whatever messages say', () => {
    const clock = new RobotClock();
    clock.take_message(AHEAD_S + 1, 1000);
    expect(clock.robot_s(1000)).toBeNull();
    expect(clock.page_ms(AHEAD_S + 1)).toBeNull();
  });

  test('a round trip of four seconds puts it half way: a message is two seconds old on arrival', () => {
    const clock = new RobotClock();
    clock.take_round_trip(1000, 5000, AHEAD_S + 3);
    expect(clock.robot_s(5000)).toBeCloseTo(AHEAD_S + 5);
    expect(5000 - (clock.page_ms(AHEAD_S + 3) ?? 0)).toBeCloseTo(2000);
  });

  test('the shortest round trip counts: a delay that is new shows in the very next message', () => {
    const clock = new RobotClock();
    clock.take_round_trip(1000, 1010, AHEAD_S + 1.005);
    clock.take_round_trip(2000, 6000, AHEAD_S + 4);
    // Sent at 6 s, it comes at 8 s.
    expect(8000 - (clock.page_ms(AHEAD_S + 6) ?? 0)).toBeCloseTo(2000, 0);
  });

  test('where all delay lies on one way the age is never told too small before it came up', () => {
    const clock = new RobotClock();
    clock.take_round_trip(0, 10, AHEAD_S + 0.005);
    // Up takes 10 ms, down 3 s from now on.
    clock.take_round_trip(1000, 4010, AHEAD_S + 1.01);
    expect(4010 - (clock.page_ms(AHEAD_S + 1.01) ?? 0)).toBeCloseTo(3000, 0);
  });

  test('a slow round trip is no better than half of it: a quick message does not contradict it', () => {
    const clock = new RobotClock();
    // Up takes 10 ms, down 390 ms; the next message is there after 5 ms.
    clock.take_round_trip(0, 400, AHEAD_S + 0.01);
    clock.take_message(AHEAD_S + 1, 1005);
    expect(clock.robot_s(1005)).not.toBeNull();
    // One that is earlier than the whole round trip allows does.
    clock.take_message(AHEAD_S + 2, 1900);
    expect(clock.robot_s(1900)).toBeNull();
  });

  test('a page that slept finds out: what contradicts the old guess replaces it', () => {
    const clock = new RobotClock();
    clock.take_round_trip(1000, 1010, AHEAD_S + 1.005);
    // The page's clock stood still for an hour.
    clock.take_round_trip(1020, 1030, AHEAD_S + 3601.025);
    expect(clock.robot_s(1030)).toBeCloseTo(AHEAD_S + 3601.03, 2);
    // A message from the future does the same, until a round trip tells.
    clock.take_message(AHEAD_S + 9999, 1040);
    expect(clock.robot_s(1040)).toBeNull();
  });

  test('a robot that began anew finds out as well, although its clock went back', () => {
    const clock = new RobotClock();
    clock.take_round_trip(1000, 1010, AHEAD_S + 1.005);
    clock.take_round_trip(2000, 2010, 7);
    expect(clock.robot_s(2005)).toBeCloseTo(7, 2);
  });

  test('after a minute a guess is too old to count', () => {
    const clock = new RobotClock();
    clock.take_round_trip(0, 2, AHEAD_S);
    clock.take_round_trip(60_001, 60_101, AHEAD_S + 60.06);
    clock.take_round_trip(60_201, 60_221, AHEAD_S + 60.21);
    expect(clock.robot_s(60_211)).toBeCloseTo(AHEAD_S + 60.21, 4);
  });
});

describe('pings', () => {
  test('an answer tells its round trip, and settles those before', () => {
    const pings = new Pings();
    const first = pings.send(1000) ?? 0;
    const second = pings.send(2000) ?? 0;
    expect(pings.unanswered_since_ms).toBe(1000);
    expect(pings.answer(second, 2500)).toBe(2000);
    expect(pings.round_trip_s).toBe(0.5);
    expect(pings.unanswered_since_ms).toBeNull();
    expect(pings.answer(first, 2600)).toBeNull();
    expect(pings.answer(77, 2600)).toBeNull();
    expect(pings.round_trip_s).toBe(0.5);
  });

  test('a dead link is not filled with them, and a new socket begins anew', () => {
    const pings = new Pings();
    let sent = 0;
    for (let k = 0; k < 1000; k += 1) if (pings.send(k) !== null) sent += 1;
    expect(sent).toBe(32);
    expect(pings.unanswered_since_ms).toBe(0);
    pings.restart();
    expect(pings.unanswered_since_ms).toBeNull();
    expect(pings.send(5000)).toBe(33);
  });
});
