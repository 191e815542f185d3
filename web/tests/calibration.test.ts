import { describe, expect, it } from 'vitest';

import {
  calibration_rows,
  kept_words,
  need_words,
  worth_keeping,
  type Calibration,
  type CalibrationValue,
} from '../src/model/calibration';

const value = (given: Partial<CalibrationValue>): CalibrationValue => ({
  quantity: 'braking',
  unit: 'm/s²',
  before: 0.6,
  after: 1.2,
  sigma: 0.02,
  inside: true,
  at_least: false,
  keeps: true,
  ...given,
});
const calibration = (given: Partial<Calibration>): Calibration => ({
  id: 1,
  state: 'done',
  kind: 'drive',
  reason: '',
  step: null,
  steps_done: 20,
  steps: 20,
  share: 1,
  left_s: null,
  values: [value({})],
  kept: false,
  kinds: [],
  ...given,
});

describe('a calibration', () => {
  it('tells before and after with how sure it is', () => {
    expect(calibration_rows(calibration({}))).toEqual([
      {
        quantity: 'braking',
        title: 'Braking',
        before: '0.60 m/s²',
        after: '1.20 m/s² ±0.02',
        note: 'used up to what is set',
      },
    ]);
  });

  it('says what is told only, not measured or out of its bounds', () => {
    const notes = (given: Partial<CalibrationValue>): string | undefined =>
      calibration_rows(calibration({ values: [value(given)] }))[0]?.note;
    expect(notes({ keeps: false })).toBe('told only');
    expect(notes({ after: null, sigma: null, inside: false })).toBe('not measured');
    expect(notes({ after: 99, inside: false })).toBe('no vehicle is so: not kept');
    expect(notes({ at_least: true, keeps: false })).toBe('as it was told: more was not asked');
  });

  it('says what is used once it is kept', () => {
    const values = [value({}), value({ quantity: 'turn_scale' }), value({ keeps: false })];
    expect(kept_words(calibration({ values }))).toBe(
      'Kept, and used from now on: Braking, Turn over ground.',
    );
  });

  it('is worth keeping only when it is done and something of it would act', () => {
    expect(worth_keeping(calibration({}))).toBe(true);
    expect(worth_keeping(calibration({ state: 'aborted' }))).toBe(false);
    expect(worth_keeping(calibration({ values: [value({ keeps: false })] }))).toBe(false);
    expect(worth_keeping(calibration({ values: [value({ inside: false })] }))).toBe(false);
  });

  it('says in words what room it needs', () => {
    const space = { ahead_m: 8.3, behind_m: 2.4, left_m: 1.2, right_m: 1.2 };
    const need = { kind: 'drive' as const, possible: true, reason: '', space, corners: [] };
    expect(need_words({ ...need, seconds: 113 })).toBe(
      'It needs 9 m ahead, 3 m behind and 2 m to either side, and about 2 min.',
    );
    expect(need_words({ ...need, seconds: 41 })).toContain('about 41 s');
  });
});
