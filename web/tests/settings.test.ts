import { describe, expect, test } from 'vitest';

import { DEFAULTS, language_in, settings_of, speed_text } from '../src/model/settings';

describe('what is kept on the device', () => {
  test('comes back', () => {
    const gamepad = { uses: {}, expo: 0.2, bumpers: true, auto: true };
    const instruments = ['attitude', 'rc'] as const;
    const cues = { sound: false, vibration: true, speech: true };
    const rest = { gamepad, instruments, cues };
    const chosen = {
      language: 'fi',
      look: 'sunlight',
      speed: 'km/h',
      places: 'utm',
      trail: 'speed',
      map_up: 'heading',
      ...rest,
    } as const;
    expect(settings_of(JSON.stringify(chosen))).toEqual(chosen);
  });
  test('speaks what the device asks for, until somebody has chosen', () => {
    expect(language_in(DEFAULTS, ['nb-NO', 'en'])).toBe('nb');
    expect(language_in({ ...DEFAULTS, language: 'et' }, ['nb-NO'])).toBe('et');
  });
  test('is as at first where nothing is kept, or something else', () => {
    for (const text of [
      null,
      '',
      '{',
      '[]',
      '7',
      '"x"',
      'null',
      '{"look":"neon","speed":3.6,"trail":1}',
    ]) {
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
