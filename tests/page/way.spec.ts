// The loaded mission on the map as it will be driven; and what a pause of it says.

import {
  arm,
  extent_px,
  map_pixels,
  metres_between,
  open_page,
  pixels_per_m,
  press,
  type Color,
  type Point,
} from './page';
import { expect, test } from './station';

const WAY: Color = [6, 38, 15];

interface Way {
  readonly line: readonly Point[];
}

test('the laid way of the loaded mission is drawn, and goes when it is unloaded by another', async ({
  page,
  station,
}) => {
  test.setTimeout(120_000);
  await open_page(page, station.url);
  expect(await map_pixels(page, [WAY])).toEqual([]);
  const here = station.sim.now;
  const beside = (north_m: number, east_m: number) => ({
    type: 'waypoint',
    lat: here.lat + north_m / 111_250,
    lon: here.lon + east_m / (111_320 * Math.cos((here.lat * Math.PI) / 180)),
  });
  const load = async (name: string, items: readonly object[]): Promise<void> => {
    const mission = await station.rest<{ id: string }>('POST', '/missions', { name, items });
    await station.rest('POST', '/execution/load', { mission_id: mission.id });
  };
  await load('Angle', [beside(3, -8), beside(3, 8), beside(13, 8)]);
  const scale = await pixels_per_m(page);
  const drawn_m = async (): Promise<readonly number[]> =>
    extent_px(await map_pixels(page, [WAY])).map((px) => px / scale);
  const line_m = async (): Promise<readonly number[]> => {
    const { line } = await station.rest<Way>('GET', '/execution/way');
    const [lats, lons] = [line.map(({ lat }) => lat), line.map(({ lon }) => lon)];
    const low = { lat: Math.min(...lats), lon: Math.min(...lons) };
    const east = { ...low, lon: Math.max(...lons) };
    const north = { ...low, lat: Math.max(...lats) };
    return [metres_between(low, east), metres_between(low, north)];
  };
  const as_laid = async (): Promise<void> => {
    await expect(async () => {
      const [wide = 0, high = 0] = await drawn_m();
      const [east = 0, north = 0] = await line_m();
      expect(Math.abs(wide - east)).toBeLessThan(0.5);
      expect(Math.abs(high - north)).toBeLessThan(0.5);
    }).toPass({ timeout: 15_000 });
  };
  await as_laid();
  expect((await line_m())[0]).toBeGreaterThan(15);
  await load('Short', [beside(3, -3), beside(6, 3)]);
  await as_laid();
  expect((await drawn_m())[0]).toBeLessThan(7);

  // Said over the socket and by a request of its own, a pause is not told as refused.
  await arm(page);
  await page.getByRole('button', { name: 'Start…', exact: true }).click();
  await press(page, 'Start driving');
  const state = page.getByLabel('Mission state');
  await expect(state).toHaveText('Running');
  for (let i = 0; i < 3; i += 1) {
    await press(page, 'Pause');
    await expect(state).toHaveText('Paused');
    await page.waitForTimeout(500);
    await expect(page.getByText(/^Pause:/)).toHaveCount(0);
    await expect(page.getByRole('alert', { name: 'Refused' })).toBeHidden();
    await press(page, 'Resume');
    await expect(state).toHaveText('Running');
  }
});
