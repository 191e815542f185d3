// Modes other than the mission: a place on the map, home, single moves, and what the robot refuses.

import { arm, mark, metres_between, open_page, press, tab } from './page';
import { expect, test, type Station } from './station';

interface Vehicle {
  readonly mode: string;
  readonly activity: { readonly state: string };
  readonly home: { readonly lat: number; readonly lon: number } | null;
}

const stands_still = (station: Station): Promise<void> =>
  expect.poll(() => Math.abs(station.sim.now.speed_mps), { timeout: 5000 }).toBeLessThan(0.01);

test('“Go here” drives to the place that was tapped, and “Come home” back again', async ({
  page,
  station,
}) => {
  test.setTimeout(180_000);
  await open_page(page, station.url);
  await arm(page);
  const start = station.sim.now;
  const { home } = await station.rest<Vehicle>('GET', '/vehicle');
  expect(home).not.toBeNull();

  await mark(page, 6, 4);
  await expect(page.getByLabel('Chosen place')).toContainText(/7\.\d+ m away, 05\d° NE/);
  await press(page, 'Go here');
  await expect(page.getByLabel('Chosen place')).toBeHidden();
  await expect(page.getByRole('group', { name: 'Mode' }).first()).toContainText('GUIDED');
  await expect(page.getByLabel('Activity')).toContainText(/Going to the place.*left/s);
  await expect(page.getByRole('group', { name: 'Control' })).toContainText('Autopilot drives');
  await expect(page.getByLabel('Activity')).toContainText('Done.', { timeout: 60_000 });
  await stands_still(station);
  expect(Math.abs(metres_between(start, station.sim.now) - Math.hypot(6, 4))).toBeLessThan(0.8);

  await press(page, 'Come home');
  await expect(page.getByRole('region', { name: 'Come home' })).toContainText(/Home: 7\.\d+ m/);
  await press(page, 'Drive home');
  await expect(page.getByLabel('Activity')).toContainText('Coming home');
  await expect
    .poll(() => (home ? metres_between(home, station.sim.now) : 99), { timeout: 60_000 })
    .toBeLessThan(0.6);
  await stands_still(station);
});

test('“Dock here” wants to know how it faces there, and docks', async ({ page, station }) => {
  test.setTimeout(180_000);
  await open_page(page, station.url);
  await arm(page);
  // Some metres tell it its heading.
  await station.rest('POST', '/vehicle/move', { forward_m: 4 });
  await expect(page.getByLabel('Activity')).toContainText('Done.', { timeout: 40_000 });
  await mark(page, 0, 8);
  const dock = page.getByRole('button', { name: 'Dock here', exact: true });
  await expect(dock).toHaveAttribute('title', 'Say first how it faces when docked.');
  await page.getByLabel('Heading there, degrees').fill('0');
  await page.getByLabel('Heading there, degrees').press('Enter');
  await dock.click();
  await expect(page.getByLabel('Activity')).toContainText('Docking');
  await expect(page.getByLabel('Mode').getByRole('button', { name: 'DOCK' })).toBeVisible();
  await expect
    .poll(async () => (await station.rest<Vehicle>('GET', '/vehicle')).activity.state, {
      timeout: 90_000,
    })
    .toBe('reached');
  const off = (station.sim.now.heading_deg + 180) % 360;
  expect(Math.abs(off - 180)).toBeLessThan(5);
});

test('a move by metres and a turn by degrees are carried out and can be stopped', async ({
  page,
  station,
}) => {
  test.setTimeout(120_000);
  await page.setViewportSize({ width: 390, height: 844 });
  await open_page(page, station.url);
  await arm(page);
  await press(page, 'Move, turn');
  const before = station.sim.now;
  await press(page, 'Forward');
  await expect(page.getByLabel('Activity')).toContainText('Moving straight');
  await expect(page.getByLabel('Activity')).toContainText('Done.', { timeout: 30_000 });
  expect(Math.abs(metres_between(before, station.sim.now) - 1)).toBeLessThan(0.15);

  const heading = station.sim.now.heading_deg;
  await page.getByLabel('Degrees, on the spot').fill('45');
  await press(page, 'Right');
  await expect(page.getByLabel('Activity')).toContainText('Turning');
  await expect(page.getByLabel('Activity')).toContainText('Done.', { timeout: 30_000 });
  const turned = (station.sim.now.heading_deg - heading + 540) % 360;
  expect(Math.abs(turned - 180 - 45)).toBeLessThan(4);

  await page.getByLabel('Metres, straight').fill('20');
  await press(page, 'Forward');
  await expect.poll(() => station.sim.now.speed_mps, { timeout: 10_000 }).toBeGreaterThan(0.1);
  await press(page, 'Stop here');
  await stands_still(station);
});

test.describe('by touch', () => {
  test.use({ viewport: { width: 390, height: 844 }, hasTouch: true });

  test('a button that does nothing now says why when it is tapped', async ({ page, station }) => {
    await open_page(page, station.url);
    await page.getByRole('button', { name: 'Move, turn', exact: true }).tap();
    const forward = page.getByRole('button', { name: 'Forward', exact: true });
    await forward.scrollIntoViewIfNeeded();
    const why = page.getByRole('status', { name: 'Why not' });
    await expect(async () => {
      await forward.tap({ force: true }); // although it is disabled
      await expect(why).toHaveText('Arm the robot first.', { timeout: 1000 });
    }).toPass(); // on a busy machine the link may be too slow at first, which is said instead
    const bubble = await why.getByText('Arm the robot first.').boundingBox();
    const button = await forward.boundingBox();
    if (!bubble || !button) throw new Error('nothing to be seen');
    expect(bubble.x).toBeGreaterThanOrEqual(0);
    expect(bubble.x + bubble.width).toBeLessThanOrEqual(390);
    expect(bubble.y + bubble.height).toBeLessThanOrEqual(button.y);
    expect(button.y - bubble.y - bubble.height).toBeLessThan(20);
    const auto = page.getByRole('button', { name: 'AUTO', exact: true });
    await auto.scrollIntoViewIfNeeded();
    await expect(async () => {
      await auto.tap({ force: true });
      await expect(why).toHaveText('Load a mission first.', { timeout: 1000 });
    }).toPass();
    await page.getByRole('button', { name: 'Longer', exact: true }).tap(); // anything else
    await expect(why).toHaveText('');
  });
});

test('the menu offers every mode of the profile, says why not, and shows a refusal in words', async ({
  page,
  station,
}) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await open_page(page, station.url);
  await press(page, 'More…');
  const menu = page.getByRole('dialog');
  const { modes } = await station.rest<{ modes: string[] }>('GET', '/vehicle/capabilities');
  expect(modes.length).toBeGreaterThan(9);
  for (const mode of modes) {
    await expect(menu.getByRole('button', { name: mode, exact: true })).toBeVisible();
  }
  await expect(menu.getByRole('button', { name: 'GUIDED', exact: true })).toContainText(
    'Arm the robot first.',
  );
  // What the page cannot know it asks the robot, and shows its answer.
  await menu.getByRole('button', { name: 'SIMPLE', exact: true }).click();
  const refused = page.getByRole('alert', { name: 'Refused' });
  await expect(refused).toContainText('the heading is not known well enough');
  expect((await station.rest<Vehicle>('GET', '/vehicle')).mode).toBe('HOLD');
});

test('on a phone no alert covers a button of the map', async ({ page, station }) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await open_page(page, station.url);
  await press(page, 'Emergency stop');
  station.sim.tell({ set: { gnss_silent: true } });
  await expect(page.getByText('Emergency stop is latched.')).toBeVisible();
  await expect(page.getByLabel('Safety conditions')).toBeVisible({ timeout: 15_000 });
  const sheet = (await page.locator('main').boundingBox())?.y ?? 0;
  for (const name of ['Zoom in', 'Zoom out', 'Follow the robot', 'Hide the panel']) {
    const box = await page.getByRole('button', { name, exact: true }).boundingBox();
    expect(box && box.y + box.height, name).toBeLessThanOrEqual(sheet);
    expect(box && box.x + box.width, name).toBeLessThanOrEqual(390);
  }
  await press(page, 'Hide the panel');
  await expect(page.getByRole('button', { name: 'Show the panel' })).toBeVisible();
});

test('a way that is driven by hand is recorded and becomes a mission', async ({
  page,
  station,
}) => {
  test.setTimeout(120_000);
  await page.setViewportSize({ width: 390, height: 844 });
  await open_page(page, station.url);
  await arm(page);
  await press(page, 'Record');
  await page.getByLabel('Name (empty: the time)').fill('Along the hedge');
  await press(page, 'Start recording');
  const card = page.getByRole('region', { name: 'Record a way' });
  await expect(card).toContainText('Recording');
  await station.rest('POST', '/vehicle/move', { forward_m: 3 });
  await expect(card).toContainText(/[3-9] points/, { timeout: 30_000 });
  await expect(page.getByLabel('Activity')).toContainText('Done.', { timeout: 30_000 });
  await press(page, 'Pause');
  await expect(card).toContainText('Paused');
  await press(page, 'Go on');
  await expect(card).toContainText('Recording');
  await press(page, 'Keep it');
  await expect(page.getByLabel('Messages')).toContainText('Kept the way as “Along the hedge”');
  await expect(page.getByRole('button', { name: 'Load “Along the hedge”' })).toBeVisible();
  const list = await station.rest<{ items: { name: string }[] }>('GET', '/missions');
  expect(list.items.map(({ name }) => name)).toEqual(['Along the hedge']);

  await press(page, 'Start recording');
  await press(page, 'Forget it');
  await page.getByRole('dialog').getByRole('button', { name: 'Forget it' }).click();
  await expect(card).toContainText('Off');
  await tab(page, 'Missions');
  await expect(page.getByLabel('Stored missions').getByRole('listitem')).toHaveCount(1);
});

test('what the radio interrupted waits for “Go on”, and goes on when it is pressed', async ({
  page,
  station,
}) => {
  test.setTimeout(120_000);
  await open_page(page, station.url);
  await arm(page);
  await mark(page, 0, 12);
  await press(page, 'Go here');
  await expect.poll(() => station.sim.now.speed_mps, { timeout: 30_000 }).toBeGreaterThan(0.2);

  station.sim.tell({ radio: { swb: 'middle' } });
  await stands_still(station);
  const activity = page.getByLabel('Activity');
  await expect(activity).toContainText(/the radio took over/i);
  const go_on = activity.getByRole('button', { name: 'Go on' });
  await expect(go_on).toBeVisible();
  station.sim.tell({ radio: { swb: 'up' } });
  await expect
    .poll(async () => (await station.rest<Vehicle>('GET', '/vehicle')).activity.state)
    .toBe('held');
  // Given back, it stands until somebody says so.
  await page.waitForTimeout(1500);
  expect(Math.abs(station.sim.now.speed_mps)).toBeLessThan(0.01);

  await go_on.click();
  await expect.poll(() => station.sim.now.speed_mps, { timeout: 15_000 }).toBeGreaterThan(0.2);
  await expect(go_on).toBeHidden();
  await expect(activity).toContainText(/left/);
});
