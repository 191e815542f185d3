// The page where the robot is not: it opens from what this device kept, says that nobody answers, keeps
// what is planned, and stores it when the robot is there again.

import type { Page } from '@playwright/test';

import { draw, items, map_pixels, open_page, press, tab, type Color } from './page';
import { expect, test } from './station';

test.use({ serviceWorkers: 'allow' });

const PLAN: Color = [11, 87, 208];
const LINE = [
  [-120, -60],
  [0, -60],
  [120, -60],
] as const;

/** The worker has everything, and answers for this page. */
const kept = (page: Page): Promise<void> =>
  page.evaluate(async () => {
    await navigator.serviceWorker.ready;
    while (navigator.serviceWorker.controller === null) {
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
  });

test('a plan is made without the robot, and saved when it is back', async ({ page, station }) => {
  test.setTimeout(120_000);
  await open_page(page, station.url);
  await kept(page);
  await station.kill();

  // At home: opened anew, it never heard of the robot.
  await page.reload();
  const link = page.getByRole('group', { name: 'Link' });
  await expect(link).toHaveAttribute('data-stale', 'true');
  await expect(link).not.toContainText('Live');
  await expect(
    page.getByText(
      'The robot cannot be reached. STOP, once pressed, is repeated, but may not arrive: use the button on the robot or the radio.',
    ),
  ).toBeVisible();
  await expect(page.getByRole('group', { name: 'Position' })).not.toContainText(/RTK|GPS/);
  await tab(page, 'Plan');
  await draw(page, LINE);
  await expect(items(page)).toHaveCount(3);
  // Near where the robot was, though nothing tells where that is.
  await expect(page.getByText(/3 items · \d+(\.\d+)? m /)).toBeVisible();
  await press(page, 'Save');
  await expect(page.getByText(/no answer came/)).toBeVisible();

  // Closed and opened: it is still there. The lists that are asked for later are no old ones.
  await page.setViewportSize({ width: 390, height: 844 });
  await page.reload();
  await expect(page.locator('.scale-bar')).toHaveText(/m$/);
  await expect(page.locator('#panel > *').first()).toBeAttached();
  await tab(page, 'Plan');
  await expect(items(page)).toHaveCount(3);
  // All of it above the panel, also on a phone.
  await expect(async () => {
    const lowest = Math.max(...(await map_pixels(page, [PLAN])).map(([, y]) => y));
    expect(lowest).toBeGreaterThan(100);
    expect(lowest).toBeLessThan((await page.locator('main').boundingBox())?.y ?? 0);
  }).toPass({ timeout: 5000 });
  await tab(page, 'Missions');
  await expect(page.getByText(/cannot be reached/).first()).toBeVisible();
  // Who was not reached has not said that there is nothing.
  await expect(page.getByText('No missions stored yet.')).toBeHidden();

  await station.begin_again();
  await expect(link).toContainText('Live', { timeout: 30_000 });
  // By itself, and once.
  await expect(page.getByRole('button', { name: /3 items · .* · revision 1/ })).toBeVisible({
    timeout: 15_000,
  });
  const { items: stored } = await station.rest<{ items: { items: number }[] }>('GET', '/missions');
  expect(stored.length).toBe(1);
  await tab(page, 'Plan');
  await expect(page.getByLabel('Summary')).toContainText('saved, revision 1');
});

test('a change whose answer was lost is no quarrel with oneself', async ({ page, station }) => {
  await open_page(page, station.url);
  await tab(page, 'Plan');
  await draw(page, LINE);
  await press(page, 'Save');
  await expect(page.getByLabel('Summary')).toContainText('saved, revision 1');
  await page.getByLabel('Mission name').fill('Changed');
  await page.getByLabel('Mission name').press('Enter');
  await page.route(
    /api\/v1\/missions\/[^/]+$/,
    async (route) => {
      if (route.request().method() !== 'PUT') return route.continue();
      await route.fetch();
      return route.abort();
    },
    { times: 1 },
  );
  await press(page, 'Save');
  await expect(page.getByText(/no answer came/)).toBeVisible();
  await expect(page.getByLabel('Summary')).toContainText('saved, revision 2', { timeout: 15_000 });
  await expect(page.getByRole('dialog')).toBeHidden();
  const { items: stored } = await station.rest<{ items: { name: string; revision: number }[] }>(
    'GET',
    '/missions',
  );
  expect(stored.map(({ name, revision }) => `${name} ${revision}`)).toEqual(['Changed 2']);
});

test('what was stored although nobody answered is not stored twice', async ({ page, station }) => {
  await open_page(page, station.url);
  await tab(page, 'Plan');
  await draw(page, LINE);
  await page.route(
    /api\/v1\/missions$/,
    async (route) => {
      if (route.request().method() !== 'POST') return route.continue();
      await route.fetch();
      return route.abort();
    },
    { times: 1 },
  );
  await press(page, 'Save');
  const unknown = page.getByText(/no answer came/);
  await expect(unknown).toBeVisible();
  await page.reload();
  await tab(page, 'Plan');
  await expect(items(page)).toHaveCount(3);
  // What was tried is tried again, by itself.
  await expect(page.getByLabel('Summary')).toContainText('saved, revision 1', { timeout: 15_000 });
  await page.getByLabel('Mission name').fill('Once');
  await page.getByLabel('Mission name').press('Enter');
  await press(page, 'Save');
  await expect(page.getByLabel('Summary')).toContainText('saved, revision 2');
  await expect(unknown).toBeHidden();
  const { items: stored } = await station.rest<{ items: { name: string }[] }>('GET', '/missions');
  expect(stored.map(({ name }) => name)).toEqual(['Once']);
});

test('of all that the robot says nothing is kept', async ({ page, station }) => {
  await open_page(page, station.url);
  await kept(page);
  const paths = await page.evaluate(async () => {
    const found: string[] = [];
    for (const name of await caches.keys()) {
      const requests = await (await caches.open(name)).keys();
      found.push(...requests.map((request) => new URL(request.url).pathname));
    }
    return found;
  });
  expect(paths).toContain('/');
  expect(paths.filter((path) => path.startsWith('/assets/')).length).toBeGreaterThan(5);
  // What comes late in each language, too.
  expect(paths.filter((path) => path.startsWith('/assets/late-')).length).toBe(5);
  expect(paths.filter((path) => path.startsWith('/api/'))).toEqual(
    paths.filter((path) => path.startsWith('/api/v1/tiles')),
  );
});
