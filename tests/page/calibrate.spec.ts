// The guided calibration drive on a phone: what it needs, that it runs, and that a stop ends it.

import { arm, open_page, press } from './page';
import { expect, test } from './station';

test.use({ viewport: { width: 390, height: 780 } });

interface Vehicle {
  readonly activity: { readonly state: string };
  readonly learned: { readonly calibrated: boolean };
}

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

  await press(page, 'Calibrate the vehicle');
  const card = page.getByRole('region', { name: 'Calibrate' });
  await expect(card).toContainText(/It needs \d+ m ahead, \d+ m behind and \d+ m to either side/);
  await card.getByLabel('What').selectOption('steering');
  await expect(card).toContainText('This vehicle has no steered wheels');
  await card.getByLabel('What').selectOption('drive');
  await press(page, 'Begin');
  await expect(card.getByRole('status')).toContainText(/step \d+ of \d+/);
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
  const after = await station.rest<Vehicle>('GET', '/vehicle');
  expect(after.learned.calibrated).toBe(false);
  await press(page, 'Close');
  await expect(card.getByRole('button', { name: 'Begin' })).toBeVisible();
});
