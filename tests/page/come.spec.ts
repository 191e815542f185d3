// "Come to me": the robot follows the phone, and my place as a point of a mission.

import type { BrowserContext, Page } from '@playwright/test';

import { faults } from './axe';
import { arm, items, metres_between, open_page, press, tab, type Point } from './page';
import { expect, test, type Station } from './station';

const north_of = (at: Point, north_m: number): Point => ({
  lat: at.lat + north_m / 111_250,
  lon: at.lon,
});

/** A phone in a hand: it tells its place every 0.7 s, and wanders by a centimetre. @return ends it */
const phone = async (
  context: BrowserContext,
  at: Point,
  accuracy_m: number,
): Promise<() => void> => {
  await context.grantPermissions(['geolocation']);
  let told = 0;
  const tell = async (): Promise<void> => {
    told += 1;
    await context.setGeolocation({
      latitude: at.lat + (told % 2) * 1e-7,
      longitude: at.lon,
      accuracy: accuracy_m,
    });
  };
  await tell();
  const timer = setInterval(() => void tell().catch(() => undefined), 700);
  return () => clearInterval(timer);
};

const begin = async (page: Page, station: Station): Promise<void> => {
  await page.setViewportSize({ width: 390, height: 844 });
  await open_page(page, station.url);
  await arm(page);
};

const card_of = (page: Page) => page.getByRole('region', { name: 'Come to me' });
/** @return the card */
const call_it = async (page: Page) => {
  await press(page, 'Come to me');
  await press(page, 'Come here');
  await expect(card_of(page)).toContainText('Comes to you');
  return card_of(page);
};
const mode_of = async (station: Station): Promise<string> =>
  (await station.rest<{ mode: string }>('GET', '/vehicle')).mode;

test('the robot comes to the phone, keeps its distance, and stands when the phone falls silent', async ({
  page,
  context,
  station,
}) => {
  await begin(page, station);
  const start = { ...station.sim.now };
  const me = north_of(start, 16);
  const silent = await phone(context, me, 4);
  await press(page, 'Come to me');
  const card = card_of(page);
  await expect(card).toContainText('within 4.0 m');
  await expect(card).toContainText('It stops 6.0 m before');
  expect(await faults(page, 'come to me')).toEqual([]);
  await press(page, 'Come here');
  await expect(card).toContainText('Comes to you');
  await expect(page.getByLabel('Activity')).toContainText('Following');
  await page.screenshot({ path: '../tests/page/results/come-phone.png' });

  // It stands at the distance that was told: four metres of the phone's, two of its own.
  await expect
    .poll(() => metres_between(station.sim.now, me), { timeout: 40_000 })
    .toBeLessThan(7.5);
  await page.waitForTimeout(3000);
  const stands_m = metres_between(station.sim.now, me);
  expect(stands_m).toBeGreaterThan(5);
  expect(stands_m).toBeLessThan(7.5);
  expect(await mode_of(station)).toBe('FOLLOW');

  silent();
  await expect(card.getByRole('alert')).toContainText('does not come any more', { timeout: 6000 });
  await expect(card.getByRole('alert')).toContainText(
    /has not told its place|does not find its place/,
  );
  await expect.poll(() => mode_of(station)).toBe('HOLD');
  await expect(card.getByRole('button', { name: 'Come here' })).toBeVisible();
});

test('a phone that walks away is followed, and “Stop here” ends it', async ({
  page,
  context,
  station,
}) => {
  await begin(page, station);
  const start = { ...station.sim.now };
  const silent = await phone(context, north_of(start, 9), 3);
  const card = await call_it(page);
  silent();
  for (let k = 1; k <= 10; k += 1) {
    const at = north_of(start, 9 + 0.5 * k);
    await context.setGeolocation({ latitude: at.lat, longitude: at.lon, accuracy: 3 });
    await page.waitForTimeout(500);
  }
  expect(metres_between(station.sim.now, start)).toBeGreaterThan(3);
  await card.getByRole('button', { name: 'Stop here' }).click();
  await expect.poll(() => mode_of(station)).toBe('HOLD');
  await expect.poll(() => Math.abs(station.sim.now.speed_mps)).toBeLessThan(0.02);
  await expect(card.getByRole('alert')).toHaveCount(0);
});

test('a page that is put away makes the robot stand, and says so', async ({
  page,
  context,
  station,
}) => {
  await begin(page, station);
  const silent = await phone(context, north_of(station.sim.now, 16), 3);
  await call_it(page);
  await page.evaluate(() => {
    Object.defineProperty(document, 'visibilityState', { value: 'hidden' });
    document.dispatchEvent(new Event('visibilitychange'));
  });
  await expect.poll(() => mode_of(station)).toBe('HOLD');
  await expect(card_of(page).getByRole('alert')).toContainText('The page was put away');
  silent();
});

test('a place that is too vague, or not allowed, moves nothing and says why', async ({
  page,
  context,
  station,
}) => {
  await begin(page, station);
  await press(page, 'Come to me');
  const card = card_of(page);
  await expect(card).toContainText('may not know where the phone is');
  await expect(card.getByRole('button', { name: 'Come here' })).toHaveAttribute(
    'aria-disabled',
    'true',
  );
  await card.getByRole('button', { name: 'Do not come to me' }).click();

  const silent = await phone(context, north_of(station.sim.now, 20), 35);
  await press(page, 'Come to me');
  await expect(card).toContainText('only within 35 m');
  await expect(card.getByRole('button', { name: 'Come here' })).toHaveAttribute(
    'aria-disabled',
    'true',
  );
  silent();
  expect(await mode_of(station)).not.toBe('FOLLOW');
});

test('a page that is not secure says that it cannot know, and what helps', async ({
  page,
  station,
}) => {
  await page.addInitScript(() =>
    Object.defineProperty(window, 'isSecureContext', { value: false }),
  );
  await begin(page, station);
  await press(page, 'Come to me');
  await expect(card_of(page)).toContainText('only to a page over HTTPS');
});

test('“Come here” that is closed before the robot answered does not drive', async ({
  page,
  context,
  station,
}) => {
  await begin(page, station);
  const silent = await phone(context, north_of(station.sim.now, 16), 3);
  await page.route('**/vehicle/mode', async (route) => {
    await new Promise((done) => setTimeout(done, 600));
    await route.continue();
  });
  await press(page, 'Come to me');
  await press(page, 'Come here');
  await page.waitForTimeout(150);
  await card_of(page).getByRole('button', { name: 'Do not come to me' }).click();
  await page.waitForTimeout(3000);
  expect(await mode_of(station)).toBe('HOLD');
  await press(page, 'Come to me');
  await expect(card_of(page)).not.toContainText('Comes to you');
  silent();
});

test('a phone that becomes less sure does not end it', async ({ page, context, station }) => {
  await begin(page, station);
  const me = north_of(station.sim.now, 16);
  let silent = await phone(context, me, 3);
  const card = await call_it(page);
  silent();
  silent = await phone(context, me, 9);
  await page.waitForTimeout(5000);
  await expect(card).toContainText('within 9.0 m');
  await expect(card).toContainText('Comes to you');
  expect(await mode_of(station)).toBe('FOLLOW');
  silent();
});

test('my place becomes a point of the mission, and is undone', async ({
  page,
  context,
  station,
}) => {
  await begin(page, station);
  const me = north_of(station.sim.now, 12);
  const silent = await phone(context, me, 2.5);
  await tab(page, 'Plan');
  await press(page, 'Add my place');
  await expect(items(page)).toHaveCount(1);
  await expect(page.getByText('Added where your phone is, within 2.5 m.')).toBeVisible();
  await press(page, 'Undo');
  await expect(items(page)).toHaveCount(0);

  // And is taken for coordinates, with no card and no other map for it.
  await tab(page, 'Drive');
  await press(page, 'Go to coordinates…');
  await press(page, 'My place');
  await expect(page.getByRole('dialog').getByRole('textbox')).toHaveValue(/^58\.\d{7}, 26\.\d{7}$/);
  await expect(card_of(page)).toHaveCount(0);
  silent();
});
