// A phone: the sheet must not hide what one looks at.

import {
  draw,
  items,
  map_middle,
  metres_between,
  open_page,
  press,
  save,
  tab,
  type Point,
} from './page';
import { expect, test } from './station';

test.use({ viewport: { width: 390, height: 844 }, hasTouch: true });

test('the robot stays in the free part when a higher sheet opens', async ({ page, station }) => {
  await open_page(page, station.url);
  await press(page, 'Hide the panel');
  await tab(page, 'Plan');
  await expect(page.getByLabel('Mission name')).toBeVisible();
  await draw(page, [[0, 0]]); // where the robot should be seen
  await save(page);
  const { items: stored } = await station.rest<{ items: { id: string }[] }>('GET', '/missions');
  const mission = await station.rest<{ items: Point[] }>('GET', `/missions/${stored[0]?.id}`);
  const drawn = mission.items[0];
  expect(drawn && metres_between(drawn, station.sim.now)).toBeLessThan(1);
});

test('the item that is edited stays above the sheet', async ({ page, station }) => {
  await open_page(page, station.url);
  await tab(page, 'Plan');
  await press(page, 'Hide the panel');
  const [x] = await map_middle(page);
  const low = (await page.locator('main').boundingBox())?.y ?? 0;
  await page.touchscreen.tap(x - 100, low - 30); // the open sheet will cover this place
  await page.touchscreen.tap(x - 100, low - 30);
  await press(page, 'Show the panel');
  await expect(page.getByRole('button', { name: 'Close item' })).toBeVisible();
  await expect(items(page)).toHaveCount(1);
  const top = (await page.locator('main').boundingBox())?.y ?? 0;
  expect(top).toBeLessThan(low - 60);
  await press(page, 'Close item');
  // Where it was moved to it can be taken: a tap on it selects it and adds nothing.
  await page.touchscreen.tap(x - 100, top - 48);
  await expect(page.getByRole('button', { name: 'Close item' })).toBeVisible();
  await expect(items(page)).toHaveCount(1);
  await draw(page, [[60, 0]]);
  await expect(items(page)).toHaveCount(2);
});
