import { expect, test } from 'vitest';

import { Hold, HOLD_MS } from '../src/model/hold';

test('a hold grows while it lasts, and begins anew after it was let go', () => {
  const hold = new Hold();
  expect(hold.share(5000)).toBe(0);
  hold.begin(1000);
  hold.begin(1400); // a second finger, or a key beside it, begins nothing
  expect(hold.share(1000 + HOLD_MS / 2)).toBe(0.5);
  expect(hold.share(1000 + 3 * HOLD_MS)).toBe(1);
  hold.end();
  expect(hold.held).toBe(false);
  hold.begin(9000);
  expect(hold.share(9000 + HOLD_MS / 4)).toBe(0.25);
});
