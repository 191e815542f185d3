// Where it slipped: on the map, in the log, and forgotten.

import { arm, map_pixels, metres_between, open_page, press, tab, type Color } from './page';
import { expect, test } from './station';

/** The edge of a diamond. */
const SLIP: Color = [179, 38, 30];

test('the log switches on where it slipped, and forgets it', async ({ page, station }) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await open_page(page, station.url);
  await tab(page, 'Log');
  const card = page.getByRole('region', { name: 'Where it slipped' });
  await expect(card.getByText('Show on the map (0 places)')).toBeVisible();
  await expect(card.getByRole('button', { name: 'Forget all' })).toHaveAttribute(
    'title',
    'There are none.',
  );
  const slip = { id: 1, lat: 58.378, lon: 26.729, time: '2026-05-01T10:00:00Z' };
  let kept: readonly object[] = [{ ...slip, kind: 'slip', percent: 40, times: 3 }];
  await page.route('**/api/v1/slips**', async (route) => {
    if (route.request().method() === 'DELETE') {
      kept = [];
      await route.fulfill({ status: 204 });
    } else {
      await route.fulfill({ json: { items: kept, next_cursor: null } });
    }
  });
  await card.getByLabel('Show on the map').check();
  await expect(card).toContainText('slipped by 40 %, 3 times');
  await card.getByRole('button', { name: 'Forget all' }).click();
  await press(page, 'Forget them');
  await expect(card).toContainText('0 places');
});

test('the map looks again where it slipped, whatever panel is open', async ({ page, station }) => {
  await open_page(page, station.url);
  const here = station.sim.now;
  let kept: readonly object[] = [];
  await page.route('**/api/v1/slips**', (route) =>
    route.fulfill({ json: { items: kept, next_cursor: null } }),
  );
  await tab(page, 'Log');
  await page.getByLabel('Show on the map').check();
  await tab(page, 'Drive');
  expect(await map_pixels(page, [SLIP])).toEqual([]);
  const at = { lat: here.lat + 0.00004, lon: here.lon };
  kept = [{ id: 1, ...at, time: '2026-05-01T10:00:00Z', kind: 'dug', percent: 90, times: 1 }];
  await expect
    .poll(async () => (await map_pixels(page, [SLIP])).length, { timeout: 25_000 })
    .toBeGreaterThan(5);
});

test('a stretch of loose ground is remembered where the robot drove', async ({ page, station }) => {
  test.setTimeout(150_000);
  await open_page(page, station.url);
  await arm(page);
  await station.rest('POST', '/vehicle/move', { forward_m: 4 });
  await expect(page.getByLabel('Activity')).toContainText('Done.', { timeout: 40_000 });
  station.sim.tell({ set: { 'drive.slip': 0.5 } });
  const begun = station.sim.now;
  await station.rest('POST', '/vehicle/move', { forward_m: 8 });
  interface Slips {
    readonly items: readonly { lat: number; lon: number; kind: string; percent: number }[];
  }
  const slips = async (): Promise<Slips['items']> =>
    (await station.rest<Slips>('GET', '/slips')).items.filter(({ kind }) => kind === 'slip');
  await expect.poll(async () => (await slips()).length, { timeout: 90_000 }).toBeGreaterThan(0);
  const [first] = await slips();
  expect(first?.percent).toBeGreaterThan(25);
  expect(first ? metres_between(begun, first) : 99).toBeLessThan(9);
});
