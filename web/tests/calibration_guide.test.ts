// The guide through a calibration drive.

import { describe, expect, test } from 'vitest';

import type { CalibrationNeed } from '../src/model/calibration';
import { cure_of, meaning_of, readiness, stage_of } from '../src/model/calibration_guide';
import type { Vehicle } from '../src/model/vehicle';

const need = (given: Partial<CalibrationNeed> = {}): CalibrationNeed => ({
  kind: 'drive',
  possible: true,
  reason: '',
  space: { ahead_m: 9, behind_m: 3, left_m: 2, right_m: 2 },
  seconds: 120,
  corners: [],
  ...given,
});
const vehicle = (position: object, armed = true): Vehicle =>
  ({
    armed,
    position: { stale: false, horizontal_accuracy_m: 0.02, heading_accuracy_deg: 1.5, ...position },
  }) as unknown as Vehicle;

describe('before it begins', () => {
  test('all that the page can see is well', () => {
    expect(readiness(need(), vehicle({}))).toEqual([
      { subject: 'Position', well: true, words: '±2 cm' },
      { subject: 'Heading', well: true, words: '±1.5°' },
      { subject: 'Ground', well: true, words: 'fits, as drawn on the map' },
      { subject: 'Armed', well: true, words: 'yes' },
    ]);
  });

  test('what is not is told with what is asked for', () => {
    const fence = need({
      possible: false,
      reason:
        'the figure would leave the fence: it needs 9 m ahead, 3 m behind and 2 m to either side',
    });
    const poor = vehicle({ horizontal_accuracy_m: 0.31, heading_accuracy_deg: null }, false);
    expect(readiness(fence, poor)).toEqual([
      { subject: 'Position', well: false, words: '±31 cm, at most ±30 cm' },
      { subject: 'Heading', well: false, words: '—, at most ±14.0°' },
      { subject: 'Ground', well: false, words: 'does not fit here' },
      { subject: 'Armed', well: false, words: 'Arm the robot first.' },
    ]);
  });

  test('what is old is not known', () => {
    const [position, heading] = readiness(need(), vehicle({ stale: true }));
    expect([position?.well, heading?.well]).toEqual([false, false]);
  });
});

test('the stages follow each other, and whatever its end is, it is judged', () => {
  const states = ['none', 'running', 'done', 'failed', 'aborted'] as const;
  expect(states.map(stage_of)).toEqual(['prepare', 'drive', 'judge', 'judge', 'judge']);
});

test('each reason that the robot gives has what helps', () => {
  const cures = [
    ['the figure would leave the fence: it needs 9 m ahead', /inside the fence/],
    ['the heading is not known well enough: drive some metres', /straight ahead by hand/],
    ['the position is uncertain by 50 cm: more than 30 cm is too much to measure by', /RTK/],
    ['no position came for 2 s', /RTK/],
    ['something slows the robot: what it measured is worth nothing', /limited its speed/],
    ['it left the space that the figure needs', /firmer ground/],
    ['the ground leans too much to measure on it', /level ground/],
    ['the robot does not do what it is told in the time it should take', /battery, brakes/],
    ['a turn on the spot did not come to its end', /battery, brakes/],
  ] as const;
  // A receiver with the best fix may be the one that is contradicted: waiting for it helps nobody.
  const differ =
    "odometry and the satellites' position differ by 0.61 m within 5 s, and it cannot be told which one is wrong";
  expect(cure_of(differ)).toMatch(/contradict each other/);
  for (const [reason, cure] of cures) expect(cure_of(reason), reason).toMatch(cure);
  expect(cure_of('no compass is heard')).toBeNull();
});

test('a figure is told with what it means, if the page knows it', () => {
  expect(meaning_of('braking')).toMatch(/shorter stops/);
  expect(meaning_of('constructor')).toBe('');
});
