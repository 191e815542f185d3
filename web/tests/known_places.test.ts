// Known places: what is said of each, and what may be entered.

import { describe, expect, it } from 'vitest';

import {
  known_kind,
  known_line,
  known_off,
  known_tone,
  new_known,
  why_not_enter,
  type KnownDraft,
  type KnownPlace,
} from '../src/model/known_places';

const place: KnownPlace = {
  name: 'shed_door',
  tag: 12,
  lat: 58.378,
  lon: 26.729,
  heading_deg: 200,
  accuracy_m: 0.05,
  heading_accuracy_deg: 2,
  configured: false,
  state: 'unseen',
  off_m: null,
  off_direction_deg: null,
  sigma_m: null,
  detail: null,
  age_s: null,
};
const draft: KnownDraft = {
  name: 'shed_door',
  kind: 'tag',
  tag: 12,
  at: { lat: 58.378, lon: 26.729 },
  heading_deg: 200,
  accuracy_m: null,
};

describe('what became of a known place', () => {
  it('is told without an age where it was never seen', () => {
    expect(known_line(place)).toBe('Not seen yet');
    expect(known_tone(place)).toBe('none');
    expect(known_off(place)).toBe('—');
  });

  it('is good where it is used, and bad where it is not believed', () => {
    const seen = { ...place, age_s: 3, off_m: 0.8, off_direction_deg: 90, sigma_m: 0.05 };
    expect(known_tone({ ...seen, state: 'used' })).toBe('good');
    expect(known_tone({ ...seen, state: 'agrees' })).toBe('good');
    for (const state of ['contradicts', 'disputed', 'ambiguous'] as const) {
      expect(known_tone({ ...seen, state })).toBe('bad');
    }
    expect(known_line({ ...seen, state: 'contradicts' })).toMatch(/^Contradicts: not used, 3/);
    expect(known_off({ ...seen, state: 'contradicts' })).toBe('0.80 m ±5.0 cm, 090° E');
  });

  it('names a tag by its number, and what has none by what it is', () => {
    expect(known_kind(0)).toBe('Tag 0');
    expect(known_kind(null)).toBe('Pole or cone');
  });
});

describe('what may be entered', () => {
  it('is all that the robot would take', () => {
    expect(why_not_enter(draft, [])).toBeNull();
    expect(why_not_enter({ ...draft, kind: 'pole', tag: null }, [])).toBeNull();
  });

  it('is refused with what is missing, the name first', () => {
    for (const name of ['', 'Shed', 'a-b', 'x'.repeat(25), 'pöld']) {
      expect(why_not_enter({ ...draft, name }, [])).toMatch(/^The name/);
    }
    expect(why_not_enter(draft, ['shed_door'])).toMatch(/configuration/);
    expect(why_not_enter({ ...draft, tag: null }, [])).toMatch(/number/);
    expect(why_not_enter({ ...draft, at: null }, [])).toMatch(/place/);
  });

  it('tells of a pole no number and no direction, whatever was typed before', () => {
    const at = { lat: 58.378, lon: 26.729 };
    expect(new_known({ ...draft, at, kind: 'pole' })).toEqual({
      ...at,
      tag: null,
      heading_deg: null,
      accuracy_m: null,
    });
    expect(new_known({ ...draft, at })).toMatchObject({ tag: 12, heading_deg: 200 });
  });
});
