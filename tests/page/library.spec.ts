// Files of every format, tags, search and archive, and what is checked before a start.

import type { Page } from '@playwright/test';

import {
  extent_px,
  map_pixels,
  metres_between,
  open_page,
  press,
  tab,
  type Color,
  type Point,
} from './page';
import { expect, test, type Station } from './station';

interface Mission {
  readonly id: string;
  readonly name: string;
  readonly items: readonly (Point & { readonly type: string })[];
}

const make = (
  station: Station,
  name: string,
  places: readonly (readonly [lat: number, lon: number])[],
): Promise<Mission> =>
  station.rest<Mission>('POST', '/missions', {
    name,
    items: places.map(([lat, lon]) => ({ type: 'waypoint', lat, lon })),
  });

const names = (page: Page) =>
  page.getByRole('list', { name: 'Stored missions' }).locator('.name').allInnerTexts();

test('a file of every format that is written is read again at the same places', async ({
  page,
  station,
}) => {
  test.setTimeout(120_000);
  await page.goto(station.url);
  await tab(page, 'Missions');
  const mission = await make(station, 'Rows', [
    [58.38, 26.72],
    [58.3801, 26.7203],
    [58.3803, 26.7201],
  ]);
  const { export_formats } = await station.rest<{ export_formats: string[] }>(
    'GET',
    '/vehicle/capabilities',
  );
  expect(export_formats.length).toBeGreaterThanOrEqual(7);
  for (const format of export_formats) {
    const answer = await fetch(
      `${station.url}/api/v1/missions/${mission.id}/export?format=${format}`,
    );
    expect(answer.status, format).toBe(200);
    await page.getByLabel('Mission file').setInputFiles({
      name: `from ${format}.${format === 'follower' ? 'csv' : format}`,
      mimeType: 'application/octet-stream',
      buffer: Buffer.from(await answer.arrayBuffer()),
    });
    await expect(page.getByRole('dialog')).toContainText(/became the mission.*[34] taken/s);
    // Of what there is none, nothing is shown.
    await expect(page.getByRole('button', { name: /^0 /, pressed: true })).toHaveCount(0);
    await press(page, 'Continue');
    const list = await station.rest<{ items: { id: string }[] }>('GET', '/missions?limit=1');
    const read = await station.rest<Mission>('GET', `/missions/${list.items[0]?.id ?? ''}`);
    const found = read.items.filter(({ type }) => type === 'waypoint');
    expect(found, format).toHaveLength(3);
    found.forEach((point, k) => {
      expect(metres_between(point, mission.items[k] as Point), format).toBeLessThan(0.02);
    });
  }
});

test('an import tells by line and on the map what the robot cannot do, and where that lies', async ({
  page,
  station,
}) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await page.goto(station.url);
  await tab(page, 'Missions');
  const rows = [
    'QGC WPL 110',
    '0\t1\t0\t16\t0\t0\t0\t0\t58.38\t26.72\t0\t1',
    '1\t0\t3\t16\t0\t0\t0\t0\t58.3801\t26.7201\t0\t1',
    '2\t0\t3\t183\t9\t1500\t0\t0\t0\t0\t0\t1',
    '3\t0\t3\t82\t0\t0\t0\t0\t58.3803\t26.7203\t0\t1',
    '4\t0\t3\t201\t0\t0\t0\t0\t58.3802\t26.7206\t0\t1',
    '5\t0\t3\t16\t0\t0\t0\t0\t58.3801\t26.7208\t0\t1',
  ];
  await page.getByLabel('Mission file').setInputFiles({
    name: 'servo.waypoints',
    mimeType: 'text/plain',
    buffer: Buffer.from(rows.join('\n')),
  });
  const report = page.getByRole('dialog').getByRole('list', { name: 'Report' });
  await expect(report).toContainText('left out');
  await expect(report).toContainText(/line 4.*183/s);
  await expect(report.getByRole('listitem')).toHaveCount(3);

  // Two are crossed out: one at its own place, one around the item that it would have come after.
  const LEFT_OUT: Color = [179, 38, 30];
  const CHANGED: Color = [184, 80, 10];
  const top = (await page.getByRole('dialog').boundingBox())?.y ?? 0;
  const marks = async (color: Color) =>
    (await map_pixels(page, [color], 8)).filter(([, y]) => y < top);
  await report.getByRole('button', { name: /line 6.*201/s }).click();
  await expect.poll(async () => (await marks(LEFT_OUT)).length).toBeGreaterThan(100);
  expect((await marks(CHANGED)).length).toBeGreaterThan(100);
  await expect(report.getByRole('button', { name: /line 4/ })).toContainText('place of its own');
  const [width] = extent_px(await marks(LEFT_OUT));
  await report.getByRole('button', { name: /line 4/ }).click();
  await expect.poll(async () => extent_px(await marks(LEFT_OUT))[0]).not.toBe(width);

  // Rows that were taken as they are, too; and a changed one is edited from here.
  await page.getByRole('dialog').getByRole('button', { name: /taken/ }).click();
  await expect(report.getByRole('listitem')).toHaveCount(6);
  const changed = report.getByRole('listitem').filter({ hasText: /line 5/ });
  await changed.getByRole('button', { name: 'Edit' }).click();
  await expect(page.getByRole('dialog')).toBeHidden();
  await expect(page.getByRole('heading', { name: /^2 · / })).toBeVisible();
});

test('a table in metres without an origin is placed at home after a question', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  await tab(page, 'Missions');
  await page.getByLabel('Mission file').setInputFiles({
    name: 'track.csv',
    mimeType: 'text/csv',
    buffer: Buffer.from('x,y,z,yaw,velocity\n0,0,0,0,0.5\n5,0,0,0,0.5\n10,0,0,0,0.5\n'),
  });
  await expect(page.getByRole('dialog')).toContainText('counts metres from an origin');
  await press(page, 'Take home');
  await expect(page.getByRole('dialog')).toContainText('became the mission');
  const { home } = await station.rest<{ home: Point }>('GET', '/vehicle');
  const list = await station.rest<{ items: { id: string }[] }>('GET', '/missions');
  const read = await station.rest<Mission>('GET', `/missions/${list.items[0]?.id ?? ''}`);
  expect(metres_between(home, read.items[0] as Point)).toBeLessThan(0.05);
});

test('missions are tagged, found by name and tag, archived, deleted and brought back', async ({
  page,
  station,
}) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await page.goto(station.url);
  for (const name of ['Orchard east', 'Orchard west', 'Vineyard']) {
    await make(station, name, [[58.38, 26.72]]);
  }
  await tab(page, 'Missions');
  await expect.poll(() => names(page)).toHaveLength(3);

  await press(page, 'More about Orchard west');
  await page.getByLabel('Tags, with commas between them').fill('apples, spring');
  await page.getByLabel('Tags, with commas between them').press('Enter');
  await page.getByLabel('Tag', { exact: true }).selectOption('apples');
  await expect.poll(() => names(page)).toEqual(['Orchard west']);
  await page.getByLabel('Tag', { exact: true }).selectOption('');

  await page.getByLabel('Find a mission').fill('vine');
  await expect.poll(() => names(page)).toEqual(['Vineyard']);
  await press(page, 'More about Vineyard');
  await press(page, 'Archive');
  await expect(page.getByText('Nothing found.')).toBeVisible();
  await page.getByLabel('Find a mission').fill('');
  await expect.poll(() => names(page)).toHaveLength(2);
  await page.getByLabel('Where to look').selectOption('archive');
  await expect.poll(() => names(page)).toEqual(['Vineyard']);
  await press(page, 'More about Vineyard');
  await press(page, 'Out of the archive');
  await page.getByLabel('Where to look').selectOption('present');
  await expect.poll(() => names(page)).toHaveLength(3);

  await press(page, 'More about Vineyard');
  await press(page, 'Delete');
  await page.getByRole('dialog').getByRole('button', { name: 'Delete' }).click();
  await expect.poll(() => names(page)).toHaveLength(2);
  // While the answer is on its way, no present mission stands under the buttons of deleted ones.
  let answer = (): void => undefined;
  const answered = new Promise<void>((resolve) => (answer = resolve));
  await page.route(/missions\?.*deleted/, async (route) => {
    await answered;
    await route.continue();
  });
  await page.getByLabel('Where to look').selectOption('deleted');
  await expect(page.getByRole('list', { name: 'Stored missions' })).toHaveText(/Loading/);
  answer();
  await press(page, 'Bring back');
  await page.getByLabel('Where to look').selectOption('present');
  await expect.poll(() => names(page)).toHaveLength(3);
});

test('what speaks against a mission is seen before it starts, and leads to the item', async ({
  page,
  station,
}) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await open_page(page, station.url);
  const { home } = await station.rest<{ home: Point }>('GET', '/vehicle');
  const { lat, lon } = home;
  const mission = await make(station, 'Twice', [
    [lat + 0.0001, lon],
    [lat + 0.0001, lon],
    [lat + 0.0002, lon],
  ]);
  await tab(page, 'Missions');
  await page.getByRole('button', { name: /^Twice/ }).click();
  await page.getByRole('button', { name: 'Check', exact: true }).click();
  const dialog = page.getByRole('dialog');
  await expect(dialog.getByLabel('Estimate')).toContainText(/11\.\d m long.*about/);
  await dialog.getByRole('list', { name: 'Findings' }).getByRole('button').first().click();
  await expect(page.getByRole('button', { name: 'Close item' })).toBeVisible();

  await station.rest('POST', '/execution/load', { mission_id: mission.id });
  await tab(page, 'Drive');
  await expect(page.getByLabel('Mission state')).toHaveText('Loaded');
  await expect(async () => {
    await press(page, 'Arm');
    await expect(dialog.getByRole('list', { name: 'Findings' })).toContainText('Item 2');
    await press(page, 'Arm anyway');
    // Refused while the position is not yet trusted: then again.
    const disarm = page.getByRole('button', { name: 'Disarm', exact: true });
    await expect(disarm).toBeVisible({ timeout: 2000 });
  }).toPass({ timeout: 40_000 });
  await press(page, 'Start…');
  await expect(dialog.getByRole('list', { name: 'Findings' })).toContainText('Item 2');
  await expect(dialog.getByLabel('Estimate')).toBeVisible();
});
