// How it looks while a mission runs, on a phone and on a laptop: nothing may overlap, everything that
// is touched is large enough. UPDATE_SHOTS=1 renews the README's picture.

import { mkdirSync } from 'node:fs';
import { join } from 'node:path';

import type { Page } from '@playwright/test';

import { draw, drive_it, items, open_page, press, save, tab } from './page';
import { expect, test } from './station';

const SIZES = [
  {
    name: 'phone',
    viewport: { width: 390, height: 844 },
    route: [
      [-110, -100],
      [60, -120],
      [90, 30],
      [-60, 90],
    ],
  },
  {
    name: 'laptop',
    viewport: { width: 1440, height: 900 },
    route: [
      [-90, -60],
      [70, -95],
      [150, 40],
      [20, 120],
      [-150, 60],
    ],
  },
] as const;

/** Where a picture goes: the README's own beside this file, all others among the results. */
const picture = (name: string): string => {
  const kept = name === 'page.png' && process.env['UPDATE_SHOTS'] === '1';
  const folder = join(__dirname, kept ? 'shots' : 'results/shots');
  mkdirSync(folder, { recursive: true });
  return join(folder, name);
};

interface Box {
  readonly what: string;
  readonly x: number;
  readonly y: number;
  readonly width: number;
  readonly height: number;
}

/** Everything in sight that can be pressed. */
const targets = (page: Page): Promise<Box[]> =>
  page.evaluate(() => {
    const found: Box[] = [];
    for (const element of document.querySelectorAll<HTMLElement>('button, a.button, select')) {
      const box = element.getBoundingClientRect();
      const top = document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2);
      const in_sight = top !== null && (element.contains(top) || top.contains(element));
      if (box.width === 0 || !in_sight) continue;
      const { x, y, width, height } = box;
      const what = element.getAttribute('aria-label') ?? element.innerText;
      found.push({ what, x, y, width, height });
    }
    return found;
  });

const check_layout = async (page: Page): Promise<void> => {
  const { width, height } = page.viewportSize() ?? { width: 0, height: 0 };
  const boxes = await targets(page);
  for (const box of boxes) {
    expect
      .soft(Math.min(box.width, box.height), `size of “${box.what}”`)
      .toBeGreaterThanOrEqual(44);
    expect.soft(box.x + box.width, `right edge of “${box.what}”`).toBeLessThanOrEqual(width);
  }
  const stop = boxes.find(({ what }) => what === 'Emergency stop');
  expect(stop, 'the stop button is in sight').toBeDefined();
  if (stop) expect(stop.y + stop.height).toBeLessThanOrEqual(height);
  const overflow = await page.evaluate(() => document.documentElement.scrollWidth);
  expect(overflow).toBeLessThanOrEqual(width);
};

for (const { name, viewport, route } of SIZES) {
  test.describe(name, () => {
    test.use({
      viewport,
      hasTouch: name === 'phone',
      deviceScaleFactor: name === 'phone' ? 2 : 1,
    });

    test(`a running mission looks right on a ${name}`, async ({ page, station }) => {
      test.setTimeout(150_000);
      await open_page(page, station.url);
      await tab(page, 'Plan');
      await draw(page, route);
      await expect(items(page).first()).toBeVisible();
      await check_layout(page);
      await page.getByLabel('Mission name').fill('Orchard, east rows');
      await page.getByLabel('Mission name').press('Enter');
      await save(page);
      await page.screenshot({ path: picture(`${name}-plan.png`) });
      await drive_it(page);
      await press(page, 'Show the whole mission');
      await expect(page.getByText(/^3 of/)).toBeVisible({ timeout: 90_000 });
      await page.waitForTimeout(4000);
      await check_layout(page);
      await page.screenshot({
        path: picture(name === 'laptop' ? 'page.png' : `${name}.png`),
      });
      for (const other of ['Missions', 'Log'] as const) {
        await tab(page, other);
        await check_layout(page);
      }
    });
  });
}

test('the first load is under 300 kB compressed', async ({ page, station }) => {
  let bytes = 0;
  const session = await page.context().newCDPSession(page);
  await session.send('Network.enable');
  session.on('Network.loadingFinished', ({ encodedDataLength }) => {
    bytes += encodedDataLength;
  });
  await page.goto(station.url);
  await expect(page.getByRole('group', { name: 'Link' })).toContainText('Live');
  await page.waitForLoadState('networkidle');
  expect(bytes).toBeGreaterThan(50_000);
  expect(bytes).toBeLessThan(300_000);
});
