// Staying and circling: as items of a mission, and as modes.

import {
  arm,
  draw,
  items,
  map_middle,
  map_pixels,
  mark,
  metres_between,
  open_page,
  pixels_per_m,
  press,
  save,
  tab,
  type Color,
  type Pixel,
  type Point,
} from './page';
import { expect, test, type Station } from './station';

interface Vehicle {
  readonly mode: string;
  readonly activity: { readonly kind: string | null; readonly state: string };
}
interface Mission {
  readonly items: readonly Record<string, unknown>[];
}

const PLAN: Color = [11, 87, 208];
const CHOSEN: Color = [184, 80, 10];
const ROUTE: Color = [20, 108, 46];

/** How many of them lie on the ring around a place, within 2 px. */
const on_ring = (found: readonly Pixel[], [x, y]: Pixel, radius_px: number): number =>
  found.filter(([at_x, at_y]) => Math.abs(Math.hypot(at_x - x, at_y - y) - radius_px) < 2).length;

const metres_to = (from: Point, east_m: number, north_m: number): Point => ({
  lat: from.lat + north_m / 111_250,
  lon: from.lon + east_m / (111_320 * Math.cos((from.lat * Math.PI) / 180)),
});

const stands_still = (station: Station): Promise<void> =>
  expect.poll(() => Math.abs(station.sim.now.speed_mps), { timeout: 5000 }).toBeLessThan(0.01);

for (const [device, width, height] of [
  ['phone', 390, 844],
  ['laptop', 1440, 900],
] as const) {
  test(`a circle and a loiter are added to a mission and edited on a ${device}`, async ({
    page,
    station,
  }) => {
    await page.setViewportSize({ width, height });
    await open_page(page, station.url);
    await tab(page, 'Plan');
    await draw(page, [[-40, 0]]);
    await expect(items(page)).toHaveCount(1);
    const kinds = page.getByLabel('Add another kind of item');
    await kinds.selectOption('circle');
    await page.getByLabel('Radius, m').fill('4,5');
    await page.getByLabel('Radius, m').press('Enter');
    await page.getByLabel('Turns', { exact: true }).fill('0.5');
    await page.getByLabel('Turns', { exact: true }).press('Enter');
    await page.getByLabel('Clockwise').check();
    await expect(items(page).nth(1)).toContainText('Circle of 4.5 m, 0.5 turns to the right');
    await page.getByLabel('Radius, m').fill('0.2');
    await page.getByLabel('Radius, m').press('Enter');
    await expect(page.getByText('Radius must be from 0.5 to 1000.')).toBeVisible();
    await kinds.selectOption('loiter');
    await page.getByLabel('Stay, s').fill('');
    await page.getByLabel('Stay, s').press('Enter');
    await expect(items(page).nth(2)).toContainText('Stay until resumed');
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    expect(wide).toBeLessThanOrEqual(width);
    await save(page);
    const listed = await station.rest<{ items: readonly { id: string }[] }>('GET', '/missions');
    const mission = await station.rest<Mission>('GET', `/missions/${listed.items[0]?.id ?? ''}`);
    expect(mission.items[1]).toMatchObject({
      type: 'circle',
      radius_m: 4.5,
      turns: 0.5,
      clockwise: true,
    });
    expect(mission.items[2]?.['type']).toBe('loiter');
    expect(mission.items[2]?.['seconds'] ?? null).toBeNull();
  });
}

test('“Circle here” drives around the place that was tapped, “Stay here” stays', async ({
  page,
  station,
}) => {
  test.setTimeout(180_000);
  await page.setViewportSize({ width: 390, height: 844 });
  await open_page(page, station.url);
  await arm(page);
  await station.rest('POST', '/vehicle/move', { forward_m: 4 });
  await expect(page.getByLabel('Activity')).toContainText('Done.', { timeout: 40_000 });
  await mark(page, 0, 5);
  await press(page, 'Stay or circle…');
  await page.getByLabel('Circle’s radius, m').fill('2');
  await page.getByLabel('Circle’s radius, m').press('Enter');
  await page.getByLabel('Turns (none: no end)').fill('1');
  await page.getByLabel('Turns (none: no end)').press('Enter');
  // It is seen before anything moves, around the place that was tapped.
  const scale = await pixels_per_m(page);
  const [x, y] = await map_middle(page);
  await expect
    .poll(async () => on_ring(await map_pixels(page, [CHOSEN]), [x, y - 5 * scale], 2 * scale))
    .toBeGreaterThan(30);
  await press(page, 'Circle here');
  await expect(page.getByLabel('Activity')).toContainText('2.00 m around, to the left, 1 turn');
  await expect.poll(async () => (await map_pixels(page, [ROUTE])).length).toBeGreaterThan(60);
  await expect(page.getByLabel('Mode').getByRole('button', { name: 'CIRCLE' })).toBeVisible();
  await expect(page.getByLabel('Activity')).toContainText('Circling');
  const state = async (): Promise<Vehicle['activity']> =>
    (await station.rest<Vehicle>('GET', '/vehicle')).activity;
  const from = station.sim.now;
  let farthest_m = 0;
  await expect
    .poll(
      async () => {
        farthest_m = Math.max(farthest_m, metres_between(from, station.sim.now));
        return (await state()).state;
      },
      { timeout: 120_000, intervals: [300] },
    )
    .toBe('reached');
  expect(farthest_m).toBeGreaterThan(3.5);
  await stands_still(station);

  await press(page, 'More…');
  await page.getByRole('button', { name: 'LOITER', exact: true }).click();
  await expect(page.getByLabel('Activity')).toContainText('Staying at the place');
  await expect.poll(async () => (await state()).state).toBe('waiting');
});

test('the line of a mission goes around a circle, not through its centre', async ({
  page,
  station,
}) => {
  await page.setViewportSize({ width: 1440, height: 900 });
  await open_page(page, station.url);
  await tab(page, 'Plan');
  await draw(page, [[-90, -40]]);
  await page.getByLabel('Add another kind of item').selectOption('circle');
  await page.getByLabel('Radius, m').fill('5');
  await page.getByLabel('Radius, m').press('Enter');
  await draw(page, [[200, 160]]);
  await expect(items(page)).toHaveCount(3);
  await save(page);
  const listed = await station.rest<{ items: readonly { id: string }[] }>('GET', '/missions');
  const path = `/missions/${listed.items[0]?.id ?? ''}`;
  const drawn = (await station.rest<{ items: readonly Point[] }>('GET', path)).items;
  const [first, centre] = drawn;
  if (!first || !centre) throw new Error('nothing was drawn');
  // The first place was tapped where it is known; the centre lies so far from it.
  const scale = await pixels_per_m(page);
  const [middle_x, middle_y] = await map_middle(page);
  const east_m =
    Math.sign(centre.lon - first.lon) * metres_between(first, { ...centre, lat: first.lat });
  const north_m =
    Math.sign(centre.lat - first.lat) * metres_between(first, { ...centre, lon: first.lon });
  const [x, y] = [middle_x - 90 + east_m * scale, middle_y - 40 - north_m * scale];
  await expect(async () => {
    const found = await map_pixels(page, [PLAN]);
    expect(on_ring(found, [x, y], 5 * scale)).toBeGreaterThan(100);
    // Inside there is its number, and nothing else.
    const inside = found.filter(([at_x, at_y]) => {
      const away = Math.hypot(at_x - x, at_y - y);
      return away > 24 && away < 5 * scale - 14;
    });
    expect(inside).toEqual([]);
  }).toPass({ timeout: 10_000 });
});

test('a circle is told as one item, and a stay without a time goes on by “Resume”', async ({
  page,
  station,
}) => {
  test.setTimeout(150_000);
  await page.setViewportSize({ width: 390, height: 844 });
  await open_page(page, station.url);
  await arm(page);
  await station.rest('POST', '/vehicle/move', { forward_m: 4 });
  await expect(page.getByLabel('Activity')).toContainText('Done.', { timeout: 40_000 });
  const here = station.sim.now;
  const mission = await station.rest<{ id: string }>('POST', '/missions', {
    name: 'Round and stay',
    items: [
      { type: 'waypoint', ...metres_to(here, 2, 2) },
      { type: 'circle', ...metres_to(here, 6, 2), radius_m: 1.5 },
      { type: 'loiter' },
      { type: 'waypoint', ...metres_to(here, 6, 6) },
    ],
  });
  await station.rest('POST', '/execution/load', { mission_id: mission.id });
  const preview = await station.rest<{ revision: number }>('GET', '/execution/preview');
  await station.rest('POST', '/execution/start', {
    mission_id: mission.id,
    revision: preview.revision,
  });
  interface Progress {
    readonly current_item: number | null;
    readonly distance_to_item_m: number | null;
    readonly waits_for_word: boolean;
  }
  const told: number[] = [];
  await expect
    .poll(
      async () => {
        const at = await station.rest<Progress>('GET', '/execution');
        if (at.current_item === 2) told.push(at.distance_to_item_m ?? Infinity);
        return at.waits_for_word;
      },
      { timeout: 90_000, intervals: [300] },
    )
    .toBe(true);
  // A tangent of 3.7 m and the whole ring, ever less.
  expect(told[0]).toBeGreaterThan(10);
  expect(told.at(-1)).toBeLessThan(1.5);
  const nearer = told.every((left_m, k) => k === 0 || left_m <= (told[k - 1] ?? 0) + 0.02);
  expect(nearer, told.join(' ')).toBe(true);

  const card = page.getByRole('region', { name: 'Mission' });
  await expect(card).toContainText('stays here until it is resumed');
  await stands_still(station);
  await card.getByRole('button', { name: 'Resume', exact: true }).click();
  await expect(card).toContainText('4 of 4');
  await expect(card.getByRole('button', { name: 'Resume', exact: true })).toBeHidden();
  await expect(page.getByLabel('Mission state')).toHaveText('Finished', { timeout: 60_000 });
  await expect(page.getByRole('alert', { name: 'Refused' })).toBeHidden();
});
