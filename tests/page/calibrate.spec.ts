// The guided calibration drive on a phone: what it needs, that it runs, and that a stop ends it.

import { arm, extent_px, map_pixels, open_page, pixels_per_m, press, type Color } from './page';
import { expect, test } from './station';

test.use({ viewport: { width: 390, height: 780 } });

interface Vehicle {
  readonly activity: { readonly state: string };
  readonly learned: { readonly calibrated: boolean };
}

/** Of the ground that it needs. */
const SPACE: Color = [11, 87, 208];

test('a calibration is begun from the page, and HOLD ends it without a change', async ({
  page,
  station,
}) => {
  test.setTimeout(120_000);
  await open_page(page, station.url);
  await arm(page);
  await station.rest('POST', '/vehicle/move', { forward_m: 4, speed_mps: 0.6 });
  await expect
    .poll(async () => (await station.rest<Vehicle>('GET', '/vehicle')).activity.state, {
      timeout: 40_000,
    })
    .toBe('reached');
  await press(page, 'HOLD');
  await expect(page.getByLabel('Now')).toContainText('HOLD');
  expect(await map_pixels(page, [SPACE])).toEqual([]);

  await press(page, 'Calibrate the vehicle');
  const card = page.getByRole('region', { name: 'Calibrate' });
  // A newcomer reads what it is for, what it needs, and that all of it is there.
  const stage = card.locator('[aria-current=step]');
  await expect(stage).toHaveText('Prepare');
  await expect(card).toContainText('it stops where it shall and cuts no corners');
  await expect(card).toContainText(/It needs \d+ m ahead, \d+ m behind and \d+ m to either side/);
  const ready = card.getByRole('list', { name: 'Before you begin' }).getByRole('listitem');
  await expect(ready).toHaveCount(4);
  await expect(card.getByRole('img', { name: 'not well' })).toHaveCount(0);
  await card.getByLabel('What').selectOption('steering');
  await expect(card).toContainText('This vehicle has no steered wheels');
  await card.getByLabel('What').selectOption('drive');
  // The ground that it needs is on the map, as large as the words say.
  const [, ahead = '', behind = ''] =
    /needs (\d+) m ahead, (\d+) m behind/.exec(await card.innerText()) ?? [];
  const scale = await pixels_per_m(page);
  const drawn_m = async (): Promise<number> =>
    Math.max(...extent_px(await map_pixels(page, [SPACE]))) / scale;
  const long_m = Number(ahead) + Number(behind);
  await expect.poll(drawn_m).toBeGreaterThan(0.6 * long_m);
  expect(await drawn_m()).toBeLessThan(long_m + 1.5);
  await press(page, 'Begin');
  await expect(page.getByLabel('Now')).toContainText('GUIDED');
  await expect(card.getByRole('status')).toContainText(/step \d+ of \d+/);
  await expect(stage).toHaveText('Drive');
  await expect(card).toContainText('nobody steps onto the outlined ground');
  await expect(card).toContainText('Braking');
  await expect
    .poll(() => Math.abs(station.sim.now.speed_mps), { timeout: 20_000 })
    .toBeGreaterThan(0.4);

  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  expect(wide).toBeLessThanOrEqual(390);
  await press(page, 'HOLD');
  await expect(card.getByRole('alert')).toContainText(
    /It did not finish.*HOLD.*Nothing is changed/,
  );
  await expect(stage).toHaveText('Judge');
  await expect(card).toContainText('What to do: ');
  const after = await station.rest<Vehicle>('GET', '/vehicle');
  expect(after.learned.calibrated).toBe(false);
  await expect.poll(() => map_pixels(page, [SPACE])).toEqual([]);
  await press(page, 'Close');
  await expect(card.getByRole('button', { name: 'Begin' })).toBeVisible();
});

test('a whole calibration is kept, which is said, and acts', async ({ page, station }) => {
  test.setTimeout(540_000);
  await open_page(page, station.url);
  await arm(page);
  await station.rest('POST', '/vehicle/move', { forward_m: 4, speed_mps: 0.6 });
  await expect(page.getByLabel('Activity')).toContainText('Done.', { timeout: 40_000 });
  await press(page, 'Calibrate the vehicle');
  const card = page.getByRole('region', { name: 'Calibrate' });
  const keep = card.getByRole('button', { name: 'Keep' });
  const ended = card.getByRole('alert');
  await card.getByRole('button', { name: 'Begin' }).click();
  await expect(card.getByRole('status')).toContainText(/step \d+ of \d+/);
  await expect(keep.or(ended).first()).toBeVisible({ timeout: 220_000 });
  // On a busy machine the simulated base may be silent for longer than it may be: as in the field,
  // it stands then, says so, and is begun again.
  if (await ended.isVisible()) {
    await expect(ended).toContainText('no word from the base');
    await press(page, 'Close');
    await arm(page);
    await card.getByRole('button', { name: 'Begin' }).click();
  }
  await expect(keep).toBeVisible({ timeout: 220_000 });
  await card.getByText('What the figures mean').click();
  await expect(card).toContainText('more is shorter stops');
  await expect(card).toContainText('Discard: it drives as before.');
  await card.scrollIntoViewIfNeeded();
  await page.screenshot({ path: '../tests/page/results/calibrate-judge.png' });
  await card.getByRole('button', { name: 'Keep' }).click();
  await expect(card.getByText(/^Kept, and used from now on: .*Braking/)).toBeInViewport();
  const after = await station.rest<Vehicle>('GET', '/vehicle');
  expect(after.learned.calibrated).toBe(true);
  // It was settled: a second word finds nothing, and what was kept can be forgotten.
  await expect(station.rest('POST', '/vehicle/calibration/keep')).rejects.toThrow(/answers 409/);
  interface Told {
    readonly state: string;
    readonly kept: boolean;
  }
  const told = await station.rest<Told>('GET', '/vehicle/calibration');
  expect(told).toMatchObject({ state: 'none', kept: true });
  await press(page, 'Forget what was kept');
  await press(page, 'Forget it');
  await expect(card.getByText(/^Forgotten/)).toBeVisible();
  const forgotten = await station.rest<Vehicle>('GET', '/vehicle');
  expect(forgotten.learned.calibrated).toBe(false);
});
