// How it looks while a mission runs, on a phone and on a laptop: nothing may overlap, everything that
// is touched is large enough. UPDATE_SHOTS=1 renews the pictures of README and docs.

import { mkdirSync } from 'node:fs';
import { join } from 'node:path';

import { check_layout } from './layout';
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

/** Where a picture goes: renewed, the README's own beside this file and the others into the docs. */
const picture = (name: string): string => {
  const kept = process.env['UPDATE_SHOTS'] === '1';
  const where = name === 'page.png' ? 'shots' : '../../docs/pictures';
  const folder = join(__dirname, kept ? where : 'results/shots');
  mkdirSync(folder, { recursive: true });
  return join(folder, name);
};

for (const { name, viewport, route } of SIZES) {
  test.describe(name, () => {
    test.use({
      viewport,
      hasTouch: name === 'phone',
      deviceScaleFactor: name === 'phone' ? 2 : 1,
    });

    test(`a running mission looks right on a ${name}`, async ({ page, station }) => {
      test.setTimeout(200_000);
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
      // Less than a minute of way; more where the machine is so busy that it pauses there.
      await expect(page.getByText(/^3 of/))
        .toBeVisible({ timeout: 140_000 })
        .catch(async (late: unknown) => {
          const state = JSON.stringify(await station.rest('GET', '/execution'));
          throw new Error(`it never came to its third item: ${state}`, { cause: late });
        });
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
