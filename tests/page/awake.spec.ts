// The screen of a phone stays on while the robot is armed.

import { arm, open_page, press } from './page';
import { expect, test } from './station';

test('the screen is kept on from arming to disarming, also after the page was hidden', async ({
  page,
  station,
}) => {
  await page.addInitScript(() => {
    const held = { now: 0 };
    Object.assign(window, { held });
    const request = (): Promise<object> => {
      held.now += 1;
      const lock = {
        released: false,
        release: (): Promise<void> => {
          if (!lock.released) held.now -= 1;
          lock.released = true;
          return Promise.resolve();
        },
      };
      Object.assign(window, { lock });
      return Promise.resolve(lock);
    };
    Object.defineProperty(navigator, 'wakeLock', { value: { request } });
  });
  const held = (): Promise<number> =>
    page.evaluate(() => (window as unknown as { held: { now: number } }).held.now);
  await open_page(page, station.url);
  expect(await held()).toBe(0);
  await arm(page);
  await expect.poll(held).toBe(1);

  // The browser takes it away when another program is looked at.
  await page.evaluate(async () => {
    await (window as unknown as { lock: { release(): Promise<void> } }).lock.release();
    document.dispatchEvent(new Event('visibilitychange'));
  });
  await expect.poll(held).toBe(1);
  await press(page, 'Disarm');
  await expect.poll(held).toBe(0);
});
