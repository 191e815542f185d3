// Ground pictures as a person brings them: an orthophoto, a file of tiles, what the network has; and
// how one that lies beside is moved under the robot.

import { readFileSync } from 'node:fs';
import { join } from 'node:path';

import type { Page } from '@playwright/test';

import { geotiff } from '../../web/tests/geotiff';
import { map_middle, open_page, pixels_per_m, press, seen_pixels, tab, type Color } from './page';
import { expect, test, type Station } from './station';

const BLUE: Color = [20, 60, 180];
/** One pixel of it. */
const PNG = Buffer.from(
  'iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGMQsdkCAAFsAQXUKC7fAAAAAElFTkSuQmCC',
  'base64',
);
const MAGENTA: Color = [230, 20, 200];
const TILES = join(__dirname, '..', 'data', 'fuzz', 'tiles', 'one.mbtiles');

/** 20 m by 20 m around the robot, all of one colour, by degrees. */
const field_around = (
  { lat, lon }: { lat: number; lon: number },
  plane = 4326,
): Uint8Array<ArrayBuffer> => {
  const metre = { lat: 1 / 111_300, lon: 1 / (111_320 * Math.cos((lat * Math.PI) / 180)) };
  return geotiff({
    width: 100,
    height: 100,
    color: () => [...MAGENTA],
    corner: [lon - 10 * metre.lon, lat + 10 * metre.lat],
    pixel: [0.2 * metre.lon, 0.2 * metre.lat],
    plane,
    geographic: true,
  });
};

const open_maps = async (page: Page): Promise<void> => {
  await tab(page, 'Missions');
  await press(page, 'Maps');
  await expect(page.getByRole('heading', { name: 'Ground pictures' })).toBeVisible();
};

const bring = (page: Page, name: string, bytes: Uint8Array): Promise<void> =>
  page
    .getByLabel('Files of ground pictures')
    .setInputFiles({ name, mimeType: 'application/octet-stream', buffer: Buffer.from(bytes) });

/** Of a square of 100 pixels in the middle of the map: how many are of that colour. */
const seen_in_the_middle = async (page: Page, color: Color): Promise<number> => {
  const [x, y] = await map_middle(page);
  const clip = { x: x - 50, y: y - 50, width: 100, height: 100 };
  const picture = (await page.screenshot({ scale: 'css', clip })).toString('base64');
  return page.evaluate(
    async ({ base64, wanted }) => {
      const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
      const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
      const context = new OffscreenCanvas(100, 100).getContext('2d');
      context?.drawImage(bitmap, 0, 0);
      const data = context?.getImageData(0, 0, 100, 100).data ?? [];
      let count = 0;
      for (let k = 0; k < data.length; k += 4) {
        if (wanted.every((value, n) => Math.abs((data[k + n] ?? 0) - value) <= 12)) count += 1;
      }
      return count;
    },
    { base64: picture, wanted: color },
  );
};

const sets_of = async (station: Station): Promise<Record<string, unknown>[]> =>
  ((await station.rest('GET', '/tiles')) as { items: Record<string, unknown>[] }).items;

test('an orthophoto is cut, kept, shown under the robot, moved and deleted', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  await open_maps(page);
  await bring(page, 'Home field.tif', field_around(station.sim.now));
  await expect(page.getByText('Home field is on the robot.')).toBeVisible({ timeout: 30_000 });
  await expect(page.getByRole('radio', { name: /Home field/ })).toBeChecked();
  const [set] = await sets_of(station);
  expect(set).toMatchObject({ set: 'home-field', name: 'Home field', kept: true, grows: true });
  // It is seen, as large as it is.
  await page.getByRole('button', { name: 'More about Home field' }).click();
  await press(page, 'Show');
  await expect
    .poll(() => seen_in_the_middle(page, MAGENTA), { timeout: 20_000 })
    .toBeGreaterThan(3000);
  const seen = await seen_pixels(page, [MAGENTA], 12);
  const high = Math.max(...seen.map(([, y]) => y)) - Math.min(...seen.map(([, y]) => y));
  expect(high / (await pixels_per_m(page))).toBeCloseTo(20, -0.3);
  // What the picture shows two metres to the east of the robot is under it in truth.
  await tab(page, 'Drive');
  await press(page, 'Follow the robot');
  const [x, y] = await map_middle(page);
  const east = 2 * (await pixels_per_m(page));
  await page.mouse.click(x + east, y, { button: 'right' });
  await press(page, 'Move the picture: the robot is here');
  await page.getByRole('button', { name: 'Move it' }).click();
  await expect
    .poll(async () => (await sets_of(station))[0]?.['shift_m'])
    .toEqual([expect.closeTo(-2, 0), expect.closeTo(0, 0)]);
  // The mark is elsewhere now: pressed once more, the picture would move as far again.
  await expect(page.getByLabel('Chosen place')).toBeHidden();
  await open_maps(page);
  await page.getByRole('button', { name: 'More about Home field' }).click();
  await page.getByRole('button', { name: 'Delete', exact: true }).click();
  await page.getByRole('dialog').getByRole('button', { name: 'Delete', exact: true }).click();
  await expect(page.getByRole('radio', { name: /Home field/ })).toHaveCount(0);
  expect(await sets_of(station)).toEqual([]);
});

test('a file of tiles is sent as it is, and what is none is refused', async ({ page, station }) => {
  await open_page(page, station.url);
  await open_maps(page);
  await bring(page, 'roads.mbtiles', readFileSync(TILES));
  await expect(page.getByText('roads is on the robot.')).toBeVisible();
  await bring(page, 'notes.tif', new TextEncoder().encode('no picture at all'));
  await expect(page.getByText('notes.tif is neither MBTiles nor GeoTIFF.')).toBeVisible();
  await bring(page, 'torn.mbtiles', readFileSync(TILES).subarray(0, 600));
  await expect(page.getByText(/torn\.mbtiles is not taken/)).toBeVisible();
  await bring(page, 'torn.tif', field_around(station.sim.now).subarray(0, 900));
  await expect(page.getByText(/torn\.tif is not taken: it cannot be read/)).toBeVisible();
  await bring(page, 'buoys.tif', field_around(station.sim.now, 4267));
  await expect(page.getByText(/buoys\.tif is not taken: .*\(NAD27\)/)).toBeVisible();
  expect((await sets_of(station)).map(({ set }) => set)).toEqual(['roads']);
  // What lies less exactly than it looks says so, and goes on saying it.
  await bring(page, 'county.tif', field_around(station.sim.now, 4269));
  await expect(page.getByText(/county is on the robot\. It lies to about 4 m only/)).toBeVisible({
    timeout: 30_000,
  });
  await expect(page.locator('.map-credit')).toHaveText('± 4 m (NAD83)');
});

test.describe('with pictures in the network', () => {
  test.use({
    more: [
      ...['--set', 'layers.aerial.url=https://tiles.example.org/{z}/{x}/{-y}.png'],
      ...['--set', 'layers.aerial.attribution=Land Board'],
    ],
  });

  test('they are shown, and what is shown is kept for the field', async ({ page, station }) => {
    const nothing_comes = page.getByText('The network gives no picture of this area just now.');
    await page.route('https://tiles.example.org/**', (route) => route.abort());
    await open_page(page, station.url);
    await open_maps(page);
    await page.getByRole('radio', { name: /aerial/ }).check();
    await expect(nothing_comes).toBeVisible();
    await page.getByRole('radio', { name: 'None' }).check();
    await page.unroute('https://tiles.example.org/**');
    const asked: string[] = [];
    await page.route('https://tiles.example.org/**', async (route) => {
      const { pathname } = new URL(route.request().url());
      asked.push(pathname);
      const headers = { 'access-control-allow-origin': '*' };
      if (asked.length % 5 === 0) return route.fulfill({ status: 404, headers });
      return route.fulfill({ body: PNG, contentType: 'image/png', headers });
    });
    await page.getByRole('radio', { name: /aerial/ }).check();
    await expect(page.locator('.map-credit')).toHaveText('Land Board');
    await expect
      .poll(() => seen_in_the_middle(page, BLUE), { timeout: 20_000 })
      .toBeGreaterThan(3000);
    await expect(nothing_comes).toBeHidden();
    await page.getByLabel(/The finest picture/).fill('1');
    asked.length = 0;
    await press(page, 'Keep this area');
    const dialog = page.getByRole('dialog');
    const told = Number(/(\d+) tiles of aerial/.exec(await dialog.innerText())?.[1]);
    await dialog.getByRole('button', { name: 'Keep', exact: true }).click();
    const kept = Math.ceil(told - told / 5);
    const missing = told - kept;
    await expect(page.getByText(/tiles are on the robot/)).toContainText(`${missing} the network`);
    const [set] = await sets_of(station);
    expect(set).toMatchObject({ name: 'aerial', attribution: 'Land Board', format: 'png' });
    // Without the network it is there.
    await page.unroute('https://tiles.example.org/**');
    await page.route('https://tiles.example.org/**', (route) => route.abort());
    await page.getByRole('radio', { name: /aerial \d+ kB/ }).check();
    await expect
      .poll(() => seen_in_the_middle(page, BLUE), { timeout: 20_000 })
      .toBeGreaterThan(3000);
  });
});
