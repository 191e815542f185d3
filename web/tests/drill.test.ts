import { describe, expect, test } from 'vitest';

import {
  drill_on_map,
  drill_outcome,
  drill_places,
  drill_rows,
  drill_summary,
  drill_tone,
  type Drill,
  type DrillResult,
} from '../src/model/drill';

const pose = { lat: 58, lon: 26, heading_deg: 90 };

const result = (given: Partial<DrillResult>): DrillResult => ({
  failure: 'drive_link',
  title: 'Drive link dead',
  end: 'stands',
  reason: 'no word from the base for 0.4 s',
  zero_s: 0.4,
  stands_s: 1.44,
  way_m: 1.012,
  speed_mps: 1,
  begins: pose,
  last: { ...pose, lat: 58.00001 },
  off_way_m: 0.01,
  fence_distance_m: null,
  inside_fence: null,
  mode: 'HOLD',
  armed: true,
  estop: false,
  said: [],
  track: [pose],
  ...given,
});

const none: DrillResult = {
  failure: 'bumper',
  title: 'Bumper hit',
  end: 'not_played',
  reason: 'there is none',
};

const drill = (results: readonly DrillResult[], fence_id: string | null = null): Drill => ({
  id: 1,
  state: 'done',
  mission: null,
  fence_id,
  begins: { at_m: 1, length_m: 2, speed_mps: 1, lat: 58, lon: 26, failures: [] },
  results,
  detail: null,
  failures: [],
});

describe('a drill', () => {
  test('says how each failure ends', () => {
    expect(drill_outcome(result({}))).toBe('stands after 1.4 s, 1.01 m');
    expect(drill_outcome(result({ inside_fence: false }))).toBe(
      'stands after 1.4 s, 1.01 m, outside the fence',
    );
    expect(drill_outcome(result({ end: 'goes_on', stands_s: null, way_m: 114 }))).toBe(
      'still drives after 114 m',
    );
    expect(drill_outcome(result({ end: 'finished' }))).toBe("drives on to the mission's end");
    expect(drill_outcome(result({ end: 'home', way_m: 17.2 }))).toBe('returns home: 17.2 m');
    expect(drill_outcome(none)).toBe('not played');
  });

  test('shows what leaves the fence as the worst', () => {
    expect(drill_tone(result({}))).toBe('stands');
    expect(drill_tone(result({ end: 'goes_on' }))).toBe('on');
    expect(drill_tone(result({ end: 'goes_on', inside_fence: false }))).toBe('bad');
    expect(drill_tone(none)).toBe('none');
  });

  test('sums up: how many stand, how far at most, whether inside', () => {
    const two = [result({}), result({ way_m: 35.5 }), result({ end: 'finished' }), none];
    expect(drill_summary(drill(two))).toBe('2 of 3 stand, after 35.5 m at most.');
    expect(drill_summary(drill(two, 'f1'))).toBe(
      '2 of 3 stand, after 35.5 m at most, all inside the fence.',
    );
    expect(drill_summary(drill([result({ inside_fence: false })], 'f1'))).toContain(
      '1 outside the fence',
    );
    expect(drill_summary(drill([result({ end: 'finished' })]))).toBe('0 of 1 stand.');
  });

  test('tells of a fence only where there is one, and of a mode only where there is a program', () => {
    const value_of = (of: DrillResult, label: string): string | undefined =>
      drill_rows(of).find((row) => row.label === label)?.value;
    expect(value_of(result({}), 'Nearest to the fence')).toBeUndefined();
    expect(value_of(result({ fence_distance_m: 4.6 }), 'Nearest to the fence')).toBe('4.60 m');
    expect(value_of(result({ fence_distance_m: -0.5 }), 'Nearest to the fence')).toBe(
      '0.50 m outside',
    );
    expect(value_of(result({}), 'Afterwards')).toBe('HOLD, armed');
    expect(value_of(result({ armed: false, estop: true }), 'Afterwards')).toBe(
      'HOLD, disarmed, stop latched',
    );
    expect(value_of(result({ mode: null, zero_s: null }), 'Afterwards')).toBe('no program');
    expect(value_of(result({ zero_s: null }), 'Command zero after')).toBe('—');
    expect(drill_rows(none)).toEqual([]);
  });

  test('draws the places where it stands, and looks at them, not at those that drive on', () => {
    const far = result({ failure: 'operator_lost', end: 'finished', last: { ...pose, lat: 59 } });
    const all = drill([result({}), far, none]);
    const shown = drill_on_map(all, 'operator_lost');
    expect(shown.places.map(({ tone, chosen }) => [tone, chosen])).toEqual([
      ['stands', false],
      ['on', true],
    ]);
    expect(drill_places(all, null).every(({ lat }) => lat < 58.1)).toBe(true);
    expect(drill_places(all, 'operator_lost').some(({ lat }) => lat === 59)).toBe(true);
  });
});
