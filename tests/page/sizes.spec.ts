// A phone on its side and tablets: the panel lies beside the map, and the map keeps most of the
// screen. Whoever holds a phone upright has the panel below.

import { mkdirSync } from 'node:fs';
import { join } from 'node:path';

import type { Page } from '@playwright/test';

import { check_layout } from './layout';
import { open_page, tab } from './page';
import { expect, test } from './station';

/** @property map of the screen, at least, that neither header nor panel covers */
const SIZES = [
  { name: 'phone on its side', width: 844, height: 390, map: 0.45 },
  { name: 'small phone on its side', width: 667, height: 375, map: 0.45 },
  { name: 'tablet', width: 820, height: 1180, map: 0.5 },
  { name: 'tablet on its side', width: 1180, height: 820, map: 0.55 },
] as const;

const free_share = (page: Page): Promise<number> =>
  page.evaluate(() => {
    const box = (name: string): DOMRect | undefined =>
      document.querySelector(name)?.getBoundingClientRect();
    const left = box('main')?.right ?? 0;
    const top = box('header')?.bottom ?? 0;
    return ((innerWidth - left) * (innerHeight - top)) / (innerWidth * innerHeight);
  });

test('beside the panel the map keeps most of the screen', async ({ page, station }) => {
  await open_page(page, station.url);
  const folder = join(__dirname, 'results/shots');
  mkdirSync(folder, { recursive: true });
  for (const { name, width, height, map } of SIZES) {
    await page.setViewportSize({ width, height });
    for (const each of ['Plan', 'Missions', 'Log', 'Drive'] as const) {
      await tab(page, each);
      await check_layout(page);
    }
    expect.soft(await free_share(page), `the map's share on a ${name}`).toBeGreaterThan(map);
    await page.screenshot({ path: join(folder, `drive-${width}x${height}.png`) });
  }
});

test('on a phone on its side the stop button covers no part of a dialog', async ({
  page,
  station,
}) => {
  await page.setViewportSize({ width: 667, height: 375 });
  await open_page(page, station.url);
  await page.getByRole('button', { name: 'More…' }).click();
  const dialog = await page.getByRole('dialog').boundingBox();
  const stop = await page.getByRole('button', { name: 'Emergency stop' }).boundingBox();
  if (!dialog || !stop) throw new Error('dialog or stop button has no place');
  expect(dialog.x + dialog.width).toBeLessThanOrEqual(stop.x);
  await check_layout(page);
});
