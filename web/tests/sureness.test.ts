import { describe, expect, it } from 'vitest';

import { sureness_of } from '../src/model/sureness';
import type { Vehicle } from '../src/model/vehicle';

const vehicle = (
  accuracy_m: number | null,
  heading_deg: number | null,
  correction_age_s: number | null,
): Vehicle =>
  ({
    position: { horizontal_accuracy_m: accuracy_m, heading_accuracy_deg: heading_deg },
    gnss: { correction_age_s },
  }) as unknown as Vehicle;
const fresh = (): boolean => false;
const lights = (...values: Parameters<typeof vehicle>): string[] =>
  sureness_of(vehicle(...values), fresh).map(({ of, words, light }) => `${of} ${words} ${light}`);

describe('how sure the robot is, as lights', () => {
  it('is well up to 5 cm, 2 degrees and corrections of 5 s', () => {
    expect(lights(0.02, 0.6, 1)).toEqual([
      'position ±2 cm good',
      'heading ±0.6° good',
      'corrections 1.0 s good',
    ]);
    expect(lights(0.05, 2, 5).every((each) => each.endsWith('good'))).toBe(true);
  });

  it('is fair up to 30 cm, 10 degrees and 30 s, and not well beyond', () => {
    expect(lights(0.06, 2.1, 6).every((each) => each.endsWith('warn'))).toBe(true);
    expect(lights(0.3, 10, 30).every((each) => each.endsWith('warn'))).toBe(true);
    expect(lights(0.31, 10.1, 31).every((each) => each.endsWith('bad'))).toBe(true);
  });

  it('does not call well what it does not know; a receiver may work without corrections', () => {
    expect(lights(null, null, null)).toEqual([
      'position — bad',
      'heading — bad',
      'corrections — none',
    ]);
  });

  it('does not call well what it was told long ago', () => {
    const old = sureness_of(vehicle(0.02, 0.6, 1), () => true);
    expect(old.map(({ light }) => light)).toEqual(['bad', 'bad', 'bad']);
  });
});
