import { describe, expect, test } from 'vitest';

import { place_in, place_text } from '../src/model/place_text';
import { place_of_utm, utm_of } from '../src/model/utm';

/** From GeographicLib 2.1, UTMUPS::Forward. */
const KNOWN = [
  [58.3780621, 26.7287794, 35, 'V', 484137.7131, 6470834.2098],
  [-33.8567844, 151.2152967, 56, 'H', 334900.2343, 6252290.4776],
  [60.3913, 5.3221, 32, 'V', 297353.9327, 6700648.3452], // Norway's wide zone
  [78.2232, 15.6267, 33, 'X', 514278.7151, 8683355.4695], // Svalbard
  [0, 0, 31, 'N', 166021.4431, 0],
  [-0.0000001, 3, 31, 'M', 500000, 9999999.9889],
  [71.1725, 25.7836, 35, 'W', 456189.3057, 7897076.0239],
  [45, 179.9999999, 60, 'T', 736446.0182, 4987329.5044],
  [44.4949, 11.3426, 32, 'T', 686248.6552, 4929511.9015],
  [83.9, -179.9, 1, 'X', 465609.1687, 9317795.7533],
] as const;

describe('UTM', () => {
  test('agrees with a library to a tenth of a millimetre, and back', () => {
    for (const [lat, lon, zone, band, east_m, north_m] of KNOWN) {
      const utm = utm_of({ lat, lon });
      expect(utm).toMatchObject({ zone, band });
      expect(Math.abs((utm?.east_m ?? NaN) - east_m)).toBeLessThan(1e-4);
      expect(Math.abs((utm?.north_m ?? NaN) - north_m)).toBeLessThan(1e-4);
      const back = place_of_utm({ zone, band, east_m, north_m });
      expect(Math.abs((back?.lat ?? NaN) - lat)).toBeLessThan(2e-9);
      expect(Math.abs((back?.lon ?? NaN) - lon) % 360).toBeLessThan(1e-8);
    }
  });
  test('is not at the poles, nor in zones, bands and rows that do not fit', () => {
    expect(utm_of({ lat: 84.1, lon: 0 })).toBeNull();
    expect(utm_of({ lat: -80.1, lon: 0 })).toBeNull();
    expect(utm_of({ lat: NaN, lon: 0 })).toBeNull();
    const good = { zone: 35, band: 'V', east_m: 484137, north_m: 6470834 };
    expect(place_of_utm(good)).not.toBeNull();
    for (const wrong of [
      { zone: 0 },
      { zone: 61 },
      { zone: 1.5 },
      { band: 'I' },
      { band: '' },
      { band: 'N' },
      { east_m: 5 },
      { east_m: NaN },
      { north_m: 1e7 + 1 },
    ]) {
      expect(place_of_utm({ ...good, ...wrong })).toBeNull();
    }
  });
});

describe('a place in words', () => {
  const tartu = { lat: 58.3780621, lon: 26.7287794 };

  test('is written in the form that was chosen', () => {
    expect(place_text(tartu, 'degrees')).toBe('58.3780621, 26.7287794');
    expect(place_text(tartu, 'dms')).toBe('58°22′41.024″N 26°43′43.606″E');
    expect(place_text(tartu, 'utm')).toBe('35V 484137.71 6470834.21');
    expect(place_text({ lat: -0.5, lon: -179.99999999 }, 'dms')).toBe(
      '0°30′00.000″S 180°00′00.000″W',
    );
    expect(place_text({ lat: 89, lon: 10 }, 'utm')).toBe('89.0000000, 10.0000000');
    expect(place_text(null, 'utm')).toBe('—');
  });

  test('is read back from every form', () => {
    for (const form of ['degrees', 'dms', 'utm'] as const) {
      const read = place_in(place_text(tartu, form));
      expect(read?.lat).toBeCloseTo(tartu.lat, 6);
      expect(read?.lon).toBeCloseTo(tartu.lon, 6);
    }
  });

  test('is read however it was pasted', () => {
    const near = { lat: 58.378, lon: 26.729 };
    for (const text of [
      '58.378, 26.729',
      ' 58.378,26.729 ',
      '58.378 26.729',
      '58.378°; 26.729°',
      '58,378 26,729',
      '58,378; 26,729',
      '58.378N 26.729E',
      '26.729°E, 58.378°N',
      `58°22'40.8"N 26°43'44.4"E`,
      `58 22' 40.8'' N, 26 43' 44.4'' E`,
      `58°22.68'N 26°43.74'E`,
    ]) {
      const read = place_in(text);
      expect(read?.lat, text).toBeCloseTo(near.lat, 9);
      expect(read?.lon, text).toBeCloseTo(near.lon, 9);
    }
    expect(place_in('-33.8567844, −70.5')).toEqual({ lat: -33.8567844, lon: -70.5 });
    expect(place_in('35v 484137,71 6470834,21')?.lat).toBeCloseTo(tartu.lat, 6);
  });

  test('is not guessed', () => {
    for (const text of [
      '',
      'here',
      '58.378',
      '91, 10',
      '10, 181',
      '58,378',
      '58.378N 26.729N',
      `58°61'N 26°E`,
      '1 2 3',
      '35V 484137',
      '35I 484137 6470834',
      '58.378, 26.729, 3',
      'x58.378N 26.729E',
    ]) {
      expect(place_in(text), text).toBeNull();
    }
  });
});
