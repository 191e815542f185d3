import { describe, expect, test } from 'vitest';

import { DEFAULTS, settings_of, speed_text } from '../src/model/settings';

describe('what is kept on the device', () => {
  test('comes back', () => {
    const gamepad = { uses: {}, expo: 0.2, bumpers: true };
    const chosen = { look: 'sunlight', speed: 'km/h', places: 'utm', gamepad } as const;
    expect(settings_of(JSON.stringify(chosen))).toEqual(chosen);
  });
  test('is as at first where nothing is kept, or something else', () => {
    for (const text of [null, '', '{', '[]', '7', '"x"', 'null', '{"look":"neon","speed":3.6}']) {
      expect(settings_of(text)).toEqual(DEFAULTS);
    }
    expect(settings_of('{"speed":"km/h","more":1}')).toEqual({ ...DEFAULTS, speed: 'km/h' });
  });
});

describe('a speed', () => {
  test('is told in the unit that was chosen', () => {
    expect(speed_text(0.8, 'm/s')).toBe('0.80 m/s');
    expect(speed_text(0.8, 'km/h')).toBe('2.9 km/h');
    expect(speed_text(-0.5, 'km/h')).toBe('−1.8 km/h');
    expect(speed_text(1.5, 'm/s', 1)).toBe('1.5 m/s');
    expect(speed_text(1.5, 'km/h', 1)).toBe('5 km/h');
  });
  test('that is not known is a dash in both', () => {
    for (const unknown of [null, undefined, NaN]) {
      expect(speed_text(unknown, 'm/s')).toBe('—');
      expect(speed_text(unknown, 'km/h')).toBe('—');
    }
  });
});
