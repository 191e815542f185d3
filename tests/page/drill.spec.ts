// The drill, before the robot is sent off: what would happen, on the list and on the map, and the
// robot itself stands all the while.

import { mkdirSync } from 'node:fs';
import { join } from 'node:path';

import { metres_between, open_page, press } from './page';
import { expect, test, type Station } from './station';

const METRE_LAT = 1 / 111_360;

interface Place {
  readonly lat: number;
  readonly lon: number;
}

/** 40 m north, 20 m east and back, inside a fence; loaded. */
const load_mission = async ({ rest, sim }: Station): Promise<void> => {
  const { lat, lon } = sim.now;
  const metre_lon = METRE_LAT / Math.cos((lat * Math.PI) / 180);
  const at = (east: number, north: number): Place => ({
    lat: lat + north * METRE_LAT,
    lon: lon + east * metre_lon,
  });
  const items = [at(0, 3), at(0, 40), at(20, 40), at(20, 3)].map((place) => ({
    type: 'waypoint',
    ...place,
  }));
  const mission = await rest<{ id: string }>('POST', '/missions', {
    name: 'Orchard, east rows',
    items,
    settings: { speed_mps: 1.0 },
  });
  const fence = await rest<{ id: string }>('POST', '/fences', {
    name: 'Orchard',
    areas: [
      {
        kind: 'inclusion',
        polygon: [at(-4, -4), at(24, -4), at(24, 44), at(-4, 44)],
      },
    ],
  });
  await rest('PUT', '/fence', { fence_id: fence.id });
  await rest('POST', '/execution/load', { mission_id: mission.id });
};

const picture = (name: string): string => {
  const folder = join(__dirname, 'results/shots');
  mkdirSync(folder, { recursive: true });
  return join(folder, name);
};

for (const { name, viewport } of [
  { name: 'laptop', viewport: { width: 1440, height: 900 } },
  { name: 'phone', viewport: { width: 390, height: 844 } },
]) {
  test(`a drill on a ${name} tells where the robot would stand, and it does not move`, async ({
    page,
    station,
  }) => {
    test.setTimeout(180_000); // on a busy machine what steps back for a robot comes late
    await page.setViewportSize(viewport);
    await open_page(page, station.url);
    await load_mission(station);
    const before = station.sim.now;

    await press(page, 'Drill…');
    await expect(page.getByText('Simulated: the robot does not move.')).toBeVisible();
    await expect(page.getByText('Orchard, east rows, revision 1')).toBeVisible();
    await page.screenshot({ path: picture(`${name}-drill-before.png`) });
    await press(page, 'Play the failures');

    const results = page.getByRole('list', { name: 'Results of the drill' });
    const row = (title: string) => results.getByRole('listitem').filter({ hasText: title });
    await expect(page.getByText(/\d+ of \d+ stand, .* all inside the fence/)).toBeVisible({
      timeout: 120_000,
    });
    await expect(row('Drive link dead')).toContainText(/stands after 1\.\d s, (0|1)\.\d\d m/);
    await expect(row('No operator heard any more')).toContainText('drives on');
    await page.screenshot({ path: picture(`${name}-drill.png`) });

    await row('Drive link dead').getByRole('button').click();
    await expect(row('Drive link dead')).toContainText('Vehicle not heard');
    await expect(row('Drive link dead')).toContainText(/Command zero after\s*0\.4 s/);
    await expect(row('Drive link dead')).toContainText('HOLD, armed');
    await page.waitForTimeout(500);
    await page.screenshot({ path: picture(`${name}-drill-chosen.png`) });
    const width = await page.evaluate(() => document.documentElement.scrollWidth);
    expect(width).toBeLessThanOrEqual(viewport.width);

    expect(metres_between(before, station.sim.now)).toBe(0);
    await expect(page.getByRole('group', { name: 'Mode', exact: true })).toContainText('HOLD');
    await press(page, 'Close');
    await expect(page.getByRole('button', { name: 'Drill…' })).toBeVisible();
  });
}

test('a place and a few failures are chosen; what is refused is said', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  const begin = page.getByRole('button', { name: 'Drill…' });
  await expect(begin).toHaveAttribute('title', /Load a mission/);
  await load_mission(station);
  await expect(begin).not.toHaveAttribute('title', /Load a mission/);
  // By the keyboard one is inside then, and out again by Esc.
  await begin.press('Enter');
  const head = page.getByRole('heading', { name: /^Drill/ });
  await expect(head).toBeFocused();
  await page.keyboard.press('Escape');
  await expect(head).toHaveCount(0);
  await begin.press('Enter');
  await page.getByRole('slider').fill('20');
  await page.getByText('Failures: all').click();
  for (const box of await page.getByRole('checkbox').all()) await box.uncheck();
  await expect(page.getByRole('button', { name: 'Play the failures' })).toHaveAttribute(
    'title',
    'Choose a failure.',
  );
  await page.getByLabel('Red button on the robot').check();
  await page.getByLabel('Bumper hit').check();
  await press(page, 'Play the failures');

  const results = page.getByRole('list', { name: 'Results of the drill' });
  await expect(results.getByRole('listitem')).toHaveCount(2);
  await expect(results).toContainText('stands after 0.4 s');
  await expect(results).toContainText('not played');
  await expect(page.getByText(/^At 18\.\d m of 9\d\.\d m/)).toBeVisible();
});
