// How this device shows things: chosen once, kept on it, and seen at once.

import type { Page } from '@playwright/test';

import { open_page, press, tab } from './page';
import { expect, test } from './station';

const ground = (page: Page): Promise<string> =>
  page.evaluate(() => getComputedStyle(document.body).backgroundColor);

test('in sunlight all is black on white, also at night, and after a reload', async ({
  page,
  station,
}) => {
  await page.emulateMedia({ colorScheme: 'dark' });
  await open_page(page, station.url);
  expect(await ground(page)).toBe('rgb(20, 23, 28)');
  await tab(page, 'Log');
  await press(page, 'Sunlight');
  await expect.poll(() => ground(page)).toBe('rgb(255, 255, 255)');
  const ink = await page
    .getByRole('region', { name: 'This device' })
    .evaluate((card) => getComputedStyle(card).color);
  expect(ink).toBe('rgb(0, 0, 0)');

  await open_page(page, station.url);
  expect(await ground(page)).toBe('rgb(255, 255, 255)');
  await tab(page, 'Log');
  await press(page, 'As the device');
  await expect.poll(() => ground(page)).toBe('rgb(20, 23, 28)');
});

test('speeds are told in km/h where somebody wants that', async ({ page, station }) => {
  await open_page(page, station.url);
  await tab(page, 'Log');
  await press(page, 'km/h');
  await expect(page.getByRole('group', { name: 'Speed, km/h' })).toContainText('0.0');
  await tab(page, 'Drive');
  await expect(page.getByRole('region', { name: 'Deck' })).toContainText(/Speed\s*0\.0km\/h/);
  await expect(page.getByRole('region', { name: 'Deck' })).toContainText(/0\.0\s*km\/h/);
});
