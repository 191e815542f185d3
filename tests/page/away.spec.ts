// A robot that is out of sight is pointed to from the border of the map.

import type { Page } from '@playwright/test';

import { map_middle, map_pixels, open_page, press, type Color, type Pixel } from './page';
import { expect, test } from './station';

/** Of the robot in the light. */
const ROBOT: readonly Color[] = [[17, 19, 24]];

const middle_of = (found: readonly Pixel[]): Pixel => {
  const sum = found.reduce(([x, y], [px, py]) => [x + px, y + py] as const, [0, 0] as const);
  return [sum[0] / found.length, sum[1] / found.length];
};

const pan = async (page: Page, right: number, down: number): Promise<void> => {
  const [x, y] = await map_middle(page);
  for (let k = 0; k < 4; k += 1) {
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + right, y + down, { steps: 4 });
    await page.mouse.up();
  }
};

test('an arrow shows where the robot is while it is out of sight', async ({ page, station }) => {
  await open_page(page, station.url);
  await page.mouse.move(700, 500);
  const panel = (await page.locator('main').boundingBox())?.width ?? 0;
  await expect
    .poll(async () => Math.abs(middle_of(await map_pixels(page, ROBOT))[0] - (panel + 1440) / 2))
    .toBeLessThan(30);

  // Pushed out to the right: the arrow stands at the right border, beside the buttons.
  await pan(page, 300, 0);
  const right = async (): Promise<number> => middle_of(await map_pixels(page, ROBOT))[0];
  await expect.poll(right).toBeGreaterThan(1280);
  expect(await right()).toBeLessThan(1380);

  await press(page, 'Follow the robot');
  await pan(page, 0, -200);
  const top = async (): Promise<number> => middle_of(await map_pixels(page, ROBOT))[1];
  await expect.poll(top).toBeLessThan(180);

  await press(page, 'Follow the robot');
  await expect.poll(top).toBeGreaterThan(350);
});
