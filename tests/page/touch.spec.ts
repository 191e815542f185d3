// The same with a finger, on a phone.

import { items, map_middle, open_page, tab } from './page';
import { expect, test } from './station';

test.use({ viewport: { width: 390, height: 844 }, hasTouch: true, deviceScaleFactor: 2 });

type Finger = readonly [x: number, y: number];

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

  const session = await page.context().newCDPSession(page);
  const touch = (
    type: 'touchStart' | 'touchMove' | 'touchEnd',
    ...fingers: Finger[]
  ): Promise<unknown> =>
    session.send('Input.dispatchTouchEvent', {
      type,
      touchPoints: fingers.map(([fx, fy], id) => ({ x: fx, y: fy, id })),
    });

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
