import { describe, expect, test } from 'vitest';

import type { WayHome } from '../src/model/homeward';
import type { CheckReport } from '../src/model/ports';
import {
  beginning_words,
  smoothed_words,
  start_lights,
  tolerance_words,
  type StartFacts,
} from '../src/model/start';
import type { Preview, Vehicle } from '../src/model/vehicle';

const preview = (joins_after_m: number | null, left_out: number): Preview =>
  ({ joins_after_m, left_out }) as Preview;

test('a start says where it joins its way, and what it leaves out', () => {
  expect(beginning_words(preview(null, 0))).toBe('');
  expect(beginning_words(preview(0, 0))).toBe(
    'The robot stands at the beginning of its way and goes on from there.',
  );
  expect(beginning_words(preview(2.4, 1))).toBe(
    'The robot joins its way where it stands, 2.40 m after its beginning. 1 item before it is left out; choose an item to begin there.',
  );
});

test('how far a smooth way is from its points is said, the farthest of several', () => {
  expect(smoothed_words([])).toBe('');
  const one = { first_item: 2, last_item: 41, deviation_m: 0.13 };
  expect(smoothed_words([one])).toBe(
    'Items 2 to 41 are driven as a smooth way, at most 0.13 m beside them.',
  );
  expect(smoothed_words([one, { ...one, deviation_m: 0.1 }])).toBe(
    '2 stretches of dense points are driven as a smooth way, at most 0.13 m beside them.',
  );
});

test('how near is near enough is said while a mission drives', () => {
  const mission = (arrival_radius_m: number | null): Vehicle['mission'] =>
    ({ arrival_radius_m, cross_track_limit_m: 3 }) as Vehicle['mission'];
  expect(tolerance_words(mission(null))).toBe('');
  expect(tolerance_words(mission(3.6))).toBe(
    'Counts as reached within 3.60 m; pauses 3.00 m off its way.',
  );
});

describe('the lights before a start', () => {
  const vehicle = (given: object = {}): Vehicle =>
    ({
      position: { horizontal_accuracy_m: 0.02, heading_accuracy_deg: 0.5, stale: false },
      gnss: { fix: 'rtk_fixed' },
      fence: { name: 'yard', inside: true, distance_m: 4 },
      ...given,
    }) as unknown as Vehicle;
  const first = { distance_m: 3.2, bearing_deg: 45, joins_after_m: null } as Preview;
  const home = { target_is: 'home', possible: true, distance_m: 12 } as WayHome;
  const report = { findings: [] } as unknown as CheckReport;
  const said = (given: Partial<StartFacts>): string[] =>
    start_lights({ vehicle: vehicle(), preview: first, home, report, failure: null, ...given }).map(
      ({ light, subject, words }) => `${light}: ${subject}: ${words}`,
    );

  test('are green where nothing is to be looked at', () => {
    expect(said({})).toEqual([
      'good: To its first item: 3.20 m, 045° NE',
      'good: Check: nothing speaks against it',
      'good: Fence: inside “yard”, 4.00 m from its limit',
      'good: Way home: Home, 12.0 m',
      'good: Position: RTK fixed, ±2 cm',
      'good: Heading: ±0.5°',
    ]);
  });

  test('say what is to be looked at, the worst first, and else keep their order', () => {
    const findings = [{ severity: 'warning' }, { severity: 'error' }];
    expect(
      said({
        vehicle: vehicle({
          fence: null,
          position: { horizontal_accuracy_m: 1.4, heading_accuracy_deg: 30, stale: false },
        }),
        preview: { ...first, distance_m: 48 },
        home: { ...home, possible: false, reason: 'it has no home' },
        report: { findings } as unknown as CheckReport,
      }),
    ).toEqual([
      'bad: Check: 1 error',
      'warn: To its first item: 48.0 m, 045° NE',
      'warn: Fence: none holds',
      'warn: Way home: it has no home',
      'warn: Position: RTK fixed, ±1.4 m',
      'warn: Heading: ±30.0°',
    ]);
    const lost = { horizontal_accuracy_m: 0.02, heading_accuracy_deg: null, stale: false };
    expect(said({ vehicle: vehicle({ position: lost }) })[0]).toBe('bad: Heading: not known');
    expect(said({ report: null, failure: 'no answer' })[0]).toBe('warn: Check: no answer');
    const outside = vehicle({ fence: { name: 'yard', inside: false, distance_m: -0.5 } });
    expect(said({ vehicle: outside })[0]).toBe('bad: Fence: outside of “yard”, by 0.50 m');
  });
});
