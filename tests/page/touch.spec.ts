// The same with a finger, on a phone.

import type { Page } from '@playwright/test';

import { arm, items, map_middle, open_page, press, tab } from './page';
import { expect, test } from './station';

test.use({ viewport: { width: 390, height: 844 }, hasTouch: true, deviceScaleFactor: 2 });

type Finger = readonly [x: number, y: number];

/** Several fingers at once, as no method of Playwright moves them. */
const fingers_on = async (page: Page) => {
  const session = await page.context().newCDPSession(page);
  return (type: 'touchStart' | 'touchMove' | 'touchEnd', ...fingers: Finger[]): Promise<unknown> =>
    session.send('Input.dispatchTouchEvent', {
      type,
      touchPoints: fingers.map(([fx, fy], id) => ({ x: fx, y: fy, id })),
    });
};

test('a tap adds a point, a finger moves it, two fingers only zoom', async ({ page, station }) => {
  await open_page(page, station.url);
  await tab(page, 'Plan');
  const [x, y] = await map_middle(page);
  for (const [right, down] of [
    [-120, -60],
    [40, -60],
  ] as const) {
    await page.touchscreen.tap(x + right, y + down);
  }
  await expect(items(page)).toHaveCount(2);
  const places = (): Promise<string[]> => items(page).allInnerTexts();
  const drawn = await places();

  const touch = await fingers_on(page);

  await touch('touchStart', [x - 120, y - 60]);
  for (let k = 1; k <= 6; k += 1) await touch('touchMove', [x - 120, y - 60 + k * 15]);
  await touch('touchEnd');
  await expect.poll(places).not.toEqual(drawn);
  const moved = await places();
  expect(moved).toHaveLength(2);
  expect(moved[1]).toBe(drawn[1]);

  const scale = page.locator('.scale-bar');
  const before = (await scale.boundingBox())?.width ?? 0;
  const text = await scale.innerText();
  await page.getByRole('button', { name: 'Close item' }).click();
  const [mx, my] = await map_middle(page);
  await touch('touchStart', [mx - 20, my + 40], [mx + 20, my + 40]);
  for (let k = 1; k <= 6; k += 1) {
    await touch('touchMove', [mx - 20 - k * 10, my + 40], [mx + 20 + k * 10, my + 40]);
  }
  await touch('touchEnd');
  await expect
    .poll(async () => [await scale.innerText(), (await scale.boundingBox())?.width])
    .not.toEqual([text, before]);
  expect(await places()).toEqual(moved);
});

test('a pad that went under the thumb drives again by a fresh push, and by nothing else', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  await arm(page);
  await press(page, 'MANUAL');
  const pad = page.getByLabel(/^Drive pad/);
  const speed = (): number => Math.abs(station.sim.now.speed_mps);
  const touch = await fingers_on(page);
  const push = async (): Promise<Finger> => {
    await pad.scrollIntoViewIfNeeded();
    const box = await pad.boundingBox();
    if (!box) throw new Error('no drive pad');
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    await touch('touchStart', [x, y]);
    await touch('touchMove', [x, y - 20]);
    await touch('touchMove', [x, y - 60]);
    return [x, y - 60];
  };
  await page.waitForTimeout(1000);
  const [x, y] = await push();
  await expect.poll(speed, { timeout: 10_000 }).toBeGreaterThan(0.08);

  // Another page holds, and the thumb stays where it was.
  await station.rest('PUT', '/vehicle/mode', { mode: 'HOLD' });
  await expect(pad).toHaveCount(0);
  await expect.poll(speed, { timeout: 5000 }).toBeLessThan(0.01);
  await station.rest('PUT', '/vehicle/mode', { mode: 'MANUAL' });
  await expect(pad).toBeVisible();
  for (let k = 0; k < 15; k += 1) {
    await touch('touchMove', [x, y - (k % 2)]);
    await page.waitForTimeout(100);
  }
  expect(speed()).toBeLessThan(0.01);
  await touch('touchEnd');

  await page.waitForTimeout(500);
  await push();
  await expect.poll(speed, { timeout: 10_000 }).toBeGreaterThan(0.08);
  await touch('touchEnd');
  await expect.poll(speed, { timeout: 3000 }).toBeLessThan(0.01);

  // The pad goes by a stop, and the thumb is lifted where no pad is: a key and a thumb drive again.
  await push();
  await expect.poll(speed, { timeout: 10_000 }).toBeGreaterThan(0.08);
  await station.rest('POST', '/vehicle/estop');
  await expect(pad).toHaveCount(0);
  await touch('touchEnd');
  await station.rest('POST', '/vehicle/estop/reset', {});
  await arm(page);
  await press(page, 'MANUAL');
  await pad.focus();
  await page.waitForTimeout(1000);
  await page.keyboard.down('ArrowUp');
  await expect.poll(speed, { timeout: 10_000 }).toBeGreaterThan(0.08);
  await page.keyboard.up('ArrowUp');
  await expect.poll(speed, { timeout: 3000 }).toBeLessThan(0.01);
  await page.waitForTimeout(500);
  await push();
  await expect.poll(speed, { timeout: 10_000 }).toBeGreaterThan(0.08);
  await touch('touchEnd');
});
