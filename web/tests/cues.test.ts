import { describe, expect, test } from 'vitest';

import { cue_of, cue_settings_of, CUE_DEFAULTS, notes_of, vibration_of } from '../src/model/cues';

describe('what is heard', () => {
  test('is what happened to the mission, and what the robot did by itself', () => {
    const cue = (kind: string, level: 'info' | 'warning' | 'error' = 'info') =>
      cue_of({ kind, level });
    expect(cue('mission_item_added')).toBe('added');
    expect(cue('mission_item_removed')).toBe('removed');
    expect(cue('mission_cleared')).toBe('cleared');
    expect(cue('item_reached')).toBe('reached');
    expect(cue('mission_finished')).toBe('finished');
    expect(cue('mission_paused', 'warning')).toBe('failsafe');
    expect(cue('estop', 'error')).toBe('failsafe');
    // Asked for by a person.
    expect(cue('mission_paused')).toBeNull();
    expect(cue('disarmed')).toBeNull();
    expect(cue('arm_refused', 'warning')).toBeNull();
  });

  test('is unlike all else, to the ear and to the hand', () => {
    for (const all of [notes_of, vibration_of]) {
      const different = new Set(Object.values(all).map((each) => JSON.stringify(each)));
      expect(different.size).toBe(Object.keys(all).length);
    }
  });

  test('is as it was chosen; speech is off at first', () => {
    expect(CUE_DEFAULTS.speech).toBe(false);
    expect(cue_settings_of(undefined)).toEqual(CUE_DEFAULTS);
    expect(cue_settings_of({ sound: false, speech: true, vibration: 'loud' })).toEqual({
      sound: false,
      vibration: true,
      speech: true,
    });
  });
});
