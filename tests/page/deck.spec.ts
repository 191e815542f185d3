// The driving deck: four large figures, HOLD and the modes, which never move: whoever looks at the
// robot finds them without a look at the screen.

import { readFileSync } from 'node:fs';

import type { Page } from '@playwright/test';

import { draw, drive_it, mark, open_page, press, save, tab } from './page';
import { expect, test } from './station';

const SIZES = [
  ['phone', 390, 844],
  ['phone on its side', 844, 390],
  ['laptop', 1440, 900],
] as const;

const place_of_hold = async (page: Page): Promise<readonly [number, number]> => {
  const hold = page.getByRole('button', { name: 'HOLD', exact: true });
  await expect(hold).toBeInViewport({ ratio: 1 });
  const box = await hold.boundingBox();
  if (!box) throw new Error('HOLD has no place');
  return [box.x, box.y];
};

for (const [name, width, height] of SIZES) {
  test(`HOLD stays where it is on a ${name}`, async ({ page, station }) => {
    test.setTimeout(150_000);
    await page.setViewportSize({ width, height });
    await open_page(page, station.url);
    const [x, y] = await place_of_hold(page);
    const stays = async (what: string): Promise<void> => {
      const now = await place_of_hold(page);
      expect.soft(Math.hypot(now[0] - x, now[1] - y), `HOLD moved by ${what}`).toBeLessThan(1);
    };

    await mark(page, 2, 1);
    await stays('the card of a chosen place');
    await page.locator('main').evaluate((panel) => panel.scrollTo(0, panel.scrollHeight));
    await stays('scrolling');
    station.sim.tell({ set: { gnss_silent: true } });
    const position = page.getByRole('group', { name: 'Position' });
    await expect(position).toHaveAttribute('data-stale', 'true');
    await press(page, 'Arm');
    await expect(page.getByRole('alert', { name: 'Refused' })).toBeAttached();
    await stays('a refusal');
    await press(page, 'Emergency stop');
    await expect(page.getByText('Emergency stop is latched.')).toBeVisible();
    await stays('an alert');
  });
}

test('the figures tell how it drives, and are large', async ({ page, station }) => {
  await open_page(page, station.url);
  const deck = page.getByRole('region', { name: 'Deck' });
  await expect(deck).toContainText(/Off path\s*—/);
  await tab(page, 'Plan');
  await draw(page, [
    [0, -60],
    [0, -260],
  ]);
  await page.getByLabel('Mission name').fill('Ahead');
  await page.getByLabel('Mission name').press('Enter');
  await save(page);
  await drive_it(page);
  await expect(deck).toContainText(/Speed\s*0\.[1-9]\dm\/s/, { timeout: 30_000 });
  // On a phone's side no name runs into the next one: which side it is off is told by an arrow.
  await page.setViewportSize({ width: 844, height: 390 });
  const names = page.locator('.deck > dl dt');
  await expect(deck).toContainText(/Off path\s*\d+\.\dcm (left|right)/);
  await expect(names).toHaveCount(4);
  const over_px = await names.evaluateAll((all) =>
    Math.max(...all.map((one) => one.scrollWidth - one.clientWidth)),
  );
  expect(over_px).toBeLessThan(6);
  await page.setViewportSize({ width: 1440, height: 900 });
  await expect(deck).toContainText(/Off path\s*\d+\.\d(c?m)( left| right)?/);
  await expect(deck).toContainText(/To drive\s*\d+(\.\d+)?m/);
  await expect(deck).toContainText(/Time left\s*(\d+s|\d+:\d\dmin)/);
  const sizes = await deck
    .getByRole('definition')
    .evaluateAll((all) => all.map((each) => parseFloat(getComputedStyle(each).fontSize)));
  expect(Math.min(...sizes)).toBeGreaterThanOrEqual(26);
  // On a phone, too, nothing is looked for while it drives.
  await page.setViewportSize({ width: 390, height: 844 });
  await expect(page.getByRole('button', { name: 'Pause', exact: true })).toBeInViewport();
});

test('instruments are chosen and kept, and what is plotted can be stopped and saved', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  const tiles = page.getByRole('region', { name: 'Instruments' });
  await expect(tiles.getByRole('figure', { name: 'Compass' })).toContainText(/\d{3}° [NESW]/);
  await press(page, 'Instruments…');
  await press(page, 'Attitude');
  await press(page, 'Compass');
  await page.reload();
  await expect(tiles.getByRole('figure', { name: 'Attitude' })).toContainText(/\d° (left|right)/);
  await expect(tiles.getByRole('figure', { name: 'Compass' })).toHaveCount(0);

  await press(page, 'Plots of the last five minutes…');
  const plots = page.getByRole('region', { name: 'Plots' });
  await plots.getByRole('button', { name: 'Battery' }).click();
  await expect(plots.getByRole('figure', { name: 'Battery' })).toContainText(/5\d\.\d+ V/);
  await expect(plots.locator('canvas')).toHaveCount(3);
  await plots.getByRole('button', { name: 'Pause plots' }).click();
  const saved = page.waitForEvent('download');
  await plots.getByRole('button', { name: 'Save CSV' }).click();
  const text = readFileSync(await (await saved).path(), 'utf8').split('\r\n');
  expect(text[0]).toBe('time,speed_mps,deviation_m,heading_error_deg,battery_V,link_ms,gnss_m');
  expect(text[5]).toMatch(/^20\d\d-.*Z,-?[\d.]+,,,5\d/);
});
