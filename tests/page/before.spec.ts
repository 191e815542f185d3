// What a person is shown before the robot drives: what a restart left behind, where home is, what the
// check has found.

import type { Page } from '@playwright/test';

import { arm, open_page, press, press_it } from './page';
import { expect, test, type MortalStation, type Station } from './station';

interface Execution {
  readonly state: string;
  readonly current_item: number | null;
  readonly left_behind: { readonly name: string } | null;
}
const execution = (station: Station): Promise<Execution> => station.rest('GET', '/execution');

const store_mission = async (station: Station, more: object = {}): Promise<string> => {
  const { lat, lon } = station.sim.now;
  const items = [1, 2, 3].map((k) => ({ type: 'waypoint', lat: lat + k * 0.00004, lon, ...more }));
  const made = { name: 'North', items };
  return (await station.rest<{ id: string }>('POST', '/missions', made)).id;
};

const left_behind = async (station: MortalStation, page: Page): Promise<void> => {
  const id = await store_mission(station);
  await arm(page);
  await station.rest('POST', '/execution/load', { mission_id: id });
  await station.rest('POST', '/execution/start', { mission_id: id, revision: 1 });
  await expect
    .poll(() => execution(station).then((e) => e.current_item), { timeout: 40_000 })
    .toBe(2);
  await page.waitForTimeout(1500); // the place is kept once a second
  await station.kill();
  await expect(page.getByRole('group', { name: 'Link' })).toContainText('Offline');
  await station.begin_again();
  await expect(page.getByRole('group', { name: 'Link' })).toContainText('Live', {
    timeout: 20_000,
  });
};

test('a mission that a restart left behind is offered, and goes on where it stood', async ({
  page,
  station,
}) => {
  test.setTimeout(120_000);
  await page.setViewportSize({ width: 390, height: 844 });
  await open_page(page, station.url);
  await left_behind(station, page);
  const card = page.getByRole('region', { name: 'Left behind' });
  await expect(card).toContainText('“North” was under way');
  await expect(card).toContainText('item 2 of 3');
  await expect(card).toContainText('To go on: Arm the robot first.');
  await arm(page);
  await press(page, 'Go on with it');
  await expect(page.getByLabel('Mission state')).toHaveText('Running');
  await expect(card).toBeHidden();
  expect((await execution(station)).current_item).toBeGreaterThanOrEqual(2);
});

test('a mission that was left behind can be forgotten, for good', async ({ page, station }) => {
  test.setTimeout(120_000);
  await open_page(page, station.url);
  await left_behind(station, page);
  const card = page.getByRole('region', { name: 'Left behind' });
  await card.getByRole('button', { name: 'Forget it' }).click();
  await page.getByRole('dialog').getByRole('button', { name: 'Forget it' }).click();
  await expect(card).toBeHidden();
  await station.kill();
  await station.begin_again();
  await expect(page.getByRole('group', { name: 'Link' })).toContainText('Live', {
    timeout: 20_000,
  });
  expect((await execution(station)).left_behind).toBeNull();
  expect(await station.rest('GET', '/missions')).toMatchObject({ items: [{ name: 'North' }] });
});

test('“Come home” first shows target, distance and line, and says why it would do nothing', async ({
  page,
  station,
}) => {
  test.setTimeout(120_000);
  await page.setViewportSize({ width: 390, height: 844 });
  await open_page(page, station.url);
  const card = page.getByRole('region', { name: 'Come home' });
  await press(page, 'Come home');
  await expect(card).toContainText('It would do nothing: Arm the robot first.');
  await arm(page);
  await expect(card).toContainText('It stands there already (home)');

  const { lat, lon } = station.sim.now;
  await station.rest('PUT', '/vehicle/home', { lat: lat + 0.0001, lon });
  await expect(card).toContainText(/Home: 11\.\d m, (000|359|001)° N/);
  await expect(card).not.toContainText('nothing');
  expect(await station.rest('GET', '/vehicle')).toMatchObject({ mode: 'HOLD' });
  await press(page, 'Drive home');
  await expect(card).toBeHidden();
  await expect(page.getByLabel('Activity')).toContainText('Coming home');
});

test('what the check has found is seen before arming, and arming is asked once more', async ({
  page,
  station,
}) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await open_page(page, station.url);
  const id = await store_mission(station, { speed_mps: 9 });
  await station.rest('POST', '/execution/load', { mission_id: id });
  const card = page.getByRole('region', { name: 'Mission' });
  await expect(card.getByRole('list', { name: 'Findings' })).toBeVisible();
  await press(page, 'Arm');
  const dialog = page.getByRole('dialog');
  await expect(dialog).toContainText('“North” is loaded and can be driven, but:');
  await expect(dialog.getByRole('list', { name: 'Findings' })).toContainText('Asks for 9.0 m/s');
  expect(await station.rest('GET', '/vehicle')).toMatchObject({ armed: false });
  await expect(async () => {
    if (await dialog.isHidden()) await press(page, 'Arm');
    await press_it(dialog.getByRole('button', { name: 'Arm anyway' }));
    await expect(page.getByRole('button', { name: 'Disarm' })).toBeVisible({ timeout: 1500 });
  }).toPass({ timeout: 20_000 });
});

test('a safety parameter that is not as the profile says is a row before every start', async ({
  page,
  station,
}) => {
  test.setTimeout(120_000);
  await page.setViewportSize({ width: 390, height: 844 });
  await open_page(page, station.url);
  const id = await store_mission(station);
  await arm(page);
  await station.rest('POST', '/execution/load', { mission_id: id });
  const margin = '/parameters/robot.fence.margin_m';
  await expect(station.rest('PUT', margin, { value: 0.02 })).rejects.toThrow(/disarm first/);
  await press(page, 'Disarm');
  await station.rest('PUT', margin, { value: 0.02 });
  await station.rest('POST', '/vehicle/arm');
  await press(page, 'Start…');
  const findings = page.getByRole('dialog').getByRole('list', { name: 'Findings' });
  await expect(findings.getByRole('listitem')).toHaveText(
    /Setting\s*The safety parameter robot\.fence\.margin_m is 0\.02, the vehicle's profile says 0\.1/,
  );
  const start = page.getByRole('dialog').getByRole('button', { name: 'Start driving' });
  await expect(start).toBeEnabled();
});
