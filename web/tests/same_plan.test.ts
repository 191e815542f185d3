// Whether what the robot has stored is what one meant to save.

import { describe, expect, it } from 'vitest';

import type { Plan } from '../src/model/plan';
import { same_plan } from '../src/model/stored_plan';

const PLAN: Plan = {
  name: 'Field',
  items: [
    { type: 'waypoint', lat: 58.1, lon: 26.2, reverse: false },
    { type: 'wait', seconds: 3 },
  ],
};
const STORED: Plan = {
  name: 'Field',
  items: [
    { lon: 26.2, lat: 58.1, type: 'waypoint' },
    { type: 'wait', seconds: 3 },
  ],
  home: null,
  settings: { at_end: 'hold' },
};

describe('the same plan', () => {
  it('is told however it is written, with settings filled in', () => {
    expect(same_plan(PLAN, STORED)).toBe(true);
  });
  it('is another one with another name, item, order or home', () => {
    const [first, second] = PLAN.items;
    if (!first || !second) throw new Error('two items');
    expect(same_plan({ ...PLAN, name: 'Other' }, STORED)).toBe(false);
    expect(same_plan({ ...PLAN, items: [second, first] }, STORED)).toBe(false);
    expect(same_plan({ ...PLAN, items: [first] }, STORED)).toBe(false);
    expect(same_plan({ ...PLAN, items: [first, { type: 'wait', seconds: 4 }] }, STORED)).toBe(
      false,
    );
    expect(same_plan({ ...PLAN, home: { lat: 58, lon: 26 } }, STORED)).toBe(false);
    expect(same_plan({ ...PLAN, settings: { at_end: 'return' } }, STORED)).toBe(false);
  });
  it('is another one where somebody said more of an item', () => {
    const more: Plan = {
      ...STORED,
      items: STORED.items.map((i) => ({ ...i, speed_mps: 1 }) as typeof i),
    };
    expect(same_plan(PLAN, more)).toBe(false);
  });
});
