// Where the robot wants to know who is there: first set-up, log-in, my devices, on a phone.

import { make_first_admin, press, tab } from './page';
import { expect, test } from './station';

test.use({
  more: ['--set', 'server.access=true'],
  viewport: { width: 390, height: 844 },
  hasTouch: true,
});

const PASSWORD = 'four tractors in a barn';

test('the first admin is made, logs out and in again, and sees the devices', async ({
  page,
  station,
}) => {
  const live = page.getByRole('group', { name: 'Link' });
  await page.goto(station.url);
  await page.getByLabel('Code').fill('AAAA-AAAA');
  await page.getByLabel('User', { exact: true }).fill('anna');
  await page.getByLabel('Password').fill(PASSWORD);
  await press(page, 'Make the first admin');
  await expect(page.getByRole('alert')).toContainText('the code is wrong');
  await page.getByLabel('Code').fill((await station.code()).toLowerCase());
  await press(page, 'Make the first admin');
  await expect(live).toContainText('Live');

  await tab(page, 'Log');
  const devices = page.getByRole('region', { name: 'My devices' });
  await expect(devices).toContainText('anna, admin');
  await expect(devices.getByRole('listitem')).toHaveCount(1);
  await expect(devices).toContainText('This device, 127.0.0.1');
  await press(page, 'Log out');

  await page.getByLabel('User', { exact: true }).fill('anna');
  await page.getByLabel('Password').fill('something else');
  await press(page, 'Log in');
  await expect(page.getByRole('alert')).toContainText('user or password is wrong');
  // Each wrong one makes the wait longer, so that it is met however slow the browser is.
  const enter = page.getByRole('button', { name: 'Log in' });
  await expect(async () => {
    await enter.click({ timeout: 1_000 });
    await expect(page.getByRole('alert')).toContainText('too many wrong log-ins: try again in', {
      timeout: 1_000,
    });
  }).toPass();
  await page.getByLabel('Password').fill(PASSWORD);
  await expect(async () => {
    if (await enter.isVisible()) await enter.click({ timeout: 1_000 });
    await expect(live).toContainText('Live', { timeout: 3_000 });
  }).toPass();

  // Another device shows up, and can be logged out from here.
  await station.rest('POST', '/session', {
    user: 'anna',
    password: PASSWORD,
    device: 'tablet',
  });
  await tab(page, 'Log');
  await expect(devices.getByRole('listitem')).toHaveCount(2);
  await expect(devices).toContainText('tablet, 127.0.0.1');
  await press(page, 'Log it out');
  await expect(devices.getByRole('listitem')).toHaveCount(1);
});

test('anyone may stop, without a log-in', async ({ page, station }) => {
  await page.goto(station.url);
  await press(page, 'Emergency stop');
  await expect(page.getByRole('button', { name: 'Emergency stop' })).toContainText('STOPPED');
});

test('the log says who pressed the stop', async ({ page, station }) => {
  await make_first_admin(page, station, PASSWORD);
  await press(page, 'Emergency stop');
  await expect(page.getByRole('button', { name: 'Emergency stop' })).toContainText('STOPPED');
  await tab(page, 'Log');
  await expect(page.getByText('emergency stop by anna').first()).toBeVisible();
});
