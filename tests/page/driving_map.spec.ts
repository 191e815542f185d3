// What the map shows to whoever drives: how far off its way the robot may come, what is only planned,
// and how near the fence is.

import {
  arm,
  draw,
  drive_it,
  extent_px,
  map_middle,
  map_pixels,
  open_page,
  pixels_per_m,
  press,
  save,
  seen_frame,
  seen_pixels,
  tab,
  type Color,
} from './page';
import { expect, test } from './station';

const CORRIDOR: Color = [46, 160, 90];
const PLAN: Color = [11, 87, 208];
const WORDS: Color = [179, 38, 30];
const PIN: Color = [184, 80, 10];
/** Up to 0.48 and from 0.96 m/s on, of a vehicle that drives 1.2. */
const SLOW: Color = [7, 132, 115];
const FAST: Color = [76, 13, 40];
/** Beside its way by no more than 2 and 5 cm. */
const NEAR: readonly Color[] = [[30, 153, 230], SLOW];

test('along the route lies a band as wide as the robot may come off its way', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  await tab(page, 'Plan');
  await draw(page, [
    [-150, -180],
    [150, -180],
  ]);
  const long_m = 300 / (await pixels_per_m(page));
  await save(page);
  expect(await map_pixels(page, [CORRIDOR], 6)).toEqual([]);
  await drive_it(page);
  const { mission } = await station.rest<{
    mission: { cross_track_limit_m: number };
  }>('GET', '/vehicle');
  const wide_m = 2 * mission.cross_track_limit_m;
  expect(wide_m).toBeGreaterThan(1);
  // Starting has fitted the map to the way; a smaller picture is looked through sooner.
  await press(page, 'Zoom out');
  await press(page, 'Zoom out');
  await expect(async () => {
    const scale = await pixels_per_m(page);
    const [long, wide] = extent_px(await map_pixels(page, [CORRIDOR], 6));
    expect(Math.abs(wide / scale - wide_m)).toBeLessThan(0.5);
    expect(Math.abs(long / scale - long_m - wide_m)).toBeLessThan(0.8);
  }).toPass({ timeout: 30_000 });
});

test('what is only planned is faint while one drives, and full once the robot has loaded it', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  const full = async (): Promise<number> => (await map_pixels(page, [PLAN])).length;
  await tab(page, 'Plan');
  await draw(page, [
    [-150, -180],
    [150, -180],
  ]);
  await expect.poll(full).toBeGreaterThan(300);
  await save(page);
  await tab(page, 'Drive');
  await expect.poll(full).toBeLessThan(50);
  await page.getByRole('button', { name: /^Load/ }).click();
  await expect.poll(full).toBeGreaterThan(300);
});

test('near the fence its distance stands under the robot', async ({ page, station }) => {
  await open_page(page, station.url);
  expect(await map_pixels(page, [WORDS])).toEqual([]);
  const { lat, lon } = station.sim.now;
  const around = (radius_m: number) => ({
    name: 'Yard',
    areas: [{ kind: 'inclusion', circle: { lat, lon, radius_m } }],
  });
  const fence = await station.rest<{ id: string }>('POST', '/fences', around(6));
  await station.rest('PUT', '/fence', { fence_id: fence.id });
  await expect.poll(async () => (await map_pixels(page, [WORDS])).length).toBeGreaterThan(10);
});

test('the map turns with the robot, and a tap still marks what lies under it', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  const pin_at = async (right: number, down: number) => {
    await seen_frame(page);
    const [x, y] = await map_middle(page);
    const card = page.getByLabel('Chosen place');
    const told = async (): Promise<string> => {
      const words = (await card.isVisible()) ? await card.innerText() : '';
      return /-?\d+\.\d{5,}, -?\d+\.\d{5,}/.exec(words)?.[0] ?? before;
    };
    let before = '';
    before = await told();
    await page.mouse.click(x + right, y + down);
    await expect.poll(told).not.toBe(before);
    const [lat = '', lon = ''] = (await told()).split(', ');
    return { lat: Number(lat), lon: Number(lon) };
  };
  const bearing_deg = (to: { lat: number; lon: number }): number => {
    const { lat, lon } = station.sim.now;
    const east = (to.lon - lon) * Math.cos((lat * Math.PI) / 180);
    return (Math.atan2(east, to.lat - lat) * 180) / Math.PI;
  };
  const apart = (a: number, b: number): number => Math.abs(((a - b + 540) % 360) - 180);

  // With north up, up is north.
  expect(apart(bearing_deg(await pin_at(0, -150)), 0)).toBeLessThan(3);
  const turns = page.getByRole('button', {
    name: 'Turn the map with the robot',
  });
  await turns.click();
  await expect(turns).toHaveAttribute('aria-pressed', 'true');
  // As it believes: it stands, and has only its compass.
  const { position } = await station.rest<{
    position: { heading_deg: number };
  }>('GET', '/vehicle');
  const { heading_deg } = position;
  expect(apart(heading_deg, 0)).toBeGreaterThan(10); // else this would show nothing
  // Now it is where the robot looks; to the right is to its right.
  expect(apart(bearing_deg(await pin_at(0, -150)), heading_deg)).toBeLessThan(5);
  expect(apart(bearing_deg(await pin_at(150, 0)), heading_deg + 90)).toBeLessThan(5);
  // The pin is seen where the finger was.
  const [x, y] = await map_middle(page);
  const near = async (): Promise<number> => {
    const seen = await seen_pixels(page, [PIN], 6);
    return seen.filter(([px, py]) => Math.hypot(px - x - 150, py - y + 33) < 40).length;
  };
  await expect.poll(near).toBeGreaterThan(50);
  // Its needle shows where north is, and goes back with the map.
  const needle = turns.locator('svg');
  await expect(needle).not.toHaveAttribute('style', /rotate\(0deg\)/);
  await turns.click();
  await expect(needle).toHaveAttribute('style', /rotate\(0deg\)/);
  await turns.click();
  await expect(needle).not.toHaveAttribute('style', /rotate\(0deg\)/);
  // Who draws has north up again, whatever was chosen.
  await tab(page, 'Plan');
  await draw(page, [
    [0, -150],
    [120, -150],
  ]);
  await page.keyboard.press('Escape');
  await expect(async () => {
    const [wide, high] = extent_px(await map_pixels(page, [PLAN]));
    expect(wide).toBeGreaterThan(100);
    expect(high).toBeLessThan(60);
  }).toPass({ timeout: 10_000 });
});

test('the map shows how fast the way is to be driven and where it turns, and then how it was driven', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  const { lat, lon } = station.sim.now;
  const to = (east_m: number, north_m: number, more: object) => ({
    type: 'waypoint',
    lat: lat + north_m / 111_250,
    lon: lon + east_m / (111_320 * Math.cos((lat * Math.PI) / 180)),
    ...more,
  });
  const items = [to(1, 0, {}), to(4, 0, { speed_mps: 0.4 }), to(4, 5, { speed_mps: 1.1 })];
  const { id, revision } = await station.rest<{ id: string; revision: number }>(
    'POST',
    '/missions',
    { name: 'Two speeds', items },
  );
  await station.rest('POST', '/execution/load', { mission_id: id, revision });
  await press(page, 'Show the whole mission');
  const signs = page.getByRole('list', { name: 'Signs on the route' });
  await expect(signs).toContainText(/0\.4 m\/s\s*at most/);
  await expect(signs).toContainText('turns on the spot');
  const seen = async (...colors: readonly Color[]): Promise<number> =>
    (await map_pixels(page, colors)).length;
  expect(await seen(SLOW, FAST)).toBe(0);

  // Ahead: the slow leg thin, the fast one wide, and longer.
  const colours = page.getByRole('group', { name: 'Colour of the way' });
  await colours.getByRole('button', { name: 'Speed' }).click();
  await expect(page.getByRole('figure', { name: 'Colour of the way' })).toContainText('Speed, m/s');
  await expect.poll(() => seen(SLOW)).toBeGreaterThan(100);
  // Its sign lies on it, and at its ends it speeds up and brakes.
  expect(await seen(FAST)).toBeGreaterThan(1.4 * (await seen(SLOW)));

  // Driven: what is ahead is in one colour now, so these are the trail's.
  await colours.getByRole('button', { name: 'Deviation' }).click();
  await expect.poll(() => seen(...NEAR, FAST)).toBe(0);
  await arm(page);
  await press(page, 'AUTO');
  await press(page, 'Start driving');
  const state = page.getByLabel('Mission state');
  await expect(state).toHaveText('Finished', { timeout: 60_000 });
  await expect.poll(() => seen(...NEAR)).toBeGreaterThan(100);

  await colours.getByRole('button', { name: 'Speed' }).click();
  await expect.poll(() => seen(FAST)).toBeGreaterThan(100);
  expect(await seen(SLOW)).toBeGreaterThan(50);
  await colours.getByRole('button', { name: 'One colour' }).click();
  await expect.poll(() => seen(...NEAR, FAST)).toBe(0);
});
