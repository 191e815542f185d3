import { describe, expect, test } from 'vitest';

import { lights_of } from '../src/model/cures';
import type { Check } from '../src/model/vehicle';

const check = (id: string, ok: boolean, severity: Check['severity'] = 'error'): Check => ({
  id,
  ok,
  severity,
  detail: id,
});

describe('the lights before arming', () => {
  test('show what keeps it from arming first, then what is to be known', () => {
    const lights = lights_of([
      check('battery', true),
      check('heading', false, 'warning'),
      check('mission', false, 'info'),
      check('estop', false),
    ]);
    expect(lights.map(({ id, light }) => `${id} ${light}`)).toEqual([
      'estop bad',
      'heading warn',
      'battery good',
      'mission good',
    ]);
  });

  test('tell what to do, and the button that does it', () => {
    const [estop] = lights_of([check('estop', false)]);
    expect(estop?.cure).toEqual({
      words: 'When the area around it is clear, reset the stop.',
      deed: 'reset_stop',
    });
    expect(lights_of([check('radio', false)])[0]?.cure?.deed).toBeNull();
    expect(lights_of([check('estop', true)])[0]?.cure).toBeNull();
    // A newer robot may check what this page does not know.
    expect(lights_of([check('tyre_pressure', false)])[0]?.cure).toBeNull();
    // Of the computer's troubles only some are mended in the field.
    const computer = (detail: string): string | undefined =>
      lights_of([{ ...check('computer', false, 'warning'), detail }])[0]?.cure?.words;
    expect(computer('only 120 MB are left on the disk')).toContain('make room on its disk');
    expect(computer('nobody finds this robot by its name: no avahi-daemon runs')).toBeUndefined();
  });
});
