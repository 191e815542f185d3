// What reads the page aloud, and who sees little, where the robot asks who is there: axe looks at log-in,
// devices, users, tokens, who is here and who did what.

import type { Page } from '@playwright/test';

import { faults, faults_in_sunlight, faults_in_the_dark } from './axe';
import { press, tab } from './page';
import { expect, test } from './station';

test.use({ more: ['--set', 'server.access=true'], viewport: { width: 390, height: 844 } });

const PASSWORD = 'four tractors in a barn';

/** STOP is seen as a whole, whatever is asked. */
const expect_stop_in_sight = async (page: Page): Promise<void> => {
  const box = await page.getByRole('button', { name: 'Emergency stop' }).boundingBox();
  const height = page.viewportSize()?.height ?? 0;
  expect(box?.height).toBeGreaterThanOrEqual(56);
  expect(box?.y).toBeGreaterThanOrEqual(0);
  expect((box?.y ?? 0) + (box?.height ?? 0)).toBeLessThanOrEqual(height);
};

test('axe finds nothing on log-in and people, light, dark and in the sun; STOP is in sight', async ({
  page,
  station,
}) => {
  test.setTimeout(120_000);
  const found: string[] = [];
  const look = async (where: string): Promise<void> => {
    found.push(...(await faults(page, where)));
    found.push(...(await faults_in_sunlight(page, where)));
    found.push(...(await faults_in_the_dark(page, where)));
  };
  const digits = async (pin: string): Promise<void> => {
    for (const digit of pin) await press(page, digit);
  };

  // Given the first admin, who is made,
  await page.goto(station.url);
  await page.getByLabel('Code').fill(await station.code());
  await page.getByLabel('User', { exact: true }).fill('anna');
  await page.getByLabel('Password').fill(PASSWORD);
  await look('set-up');
  await press(page, 'Make the first admin');
  await expect(page.getByRole('group', { name: 'Link' })).toContainText('Live');
  await press(page, 'Who is here');
  await expect(page.getByRole('list', { name: 'Who is here' })).toContainText('that is you');
  await look('who is here');

  // who looks at what belongs to people,
  await tab(page, 'Log');
  await press(page, 'Pair this device');
  await page.getByLabel('Name of this device').fill('glove phone');
  await look('pairing');
  await digits('2580');
  await press(page, 'OK: Pair');
  await expect(page.getByRole('list', { name: 'Paired devices' })).toContainText('glove phone');
  await press(page, 'Invite a phone');
  await press(page, 'Show a code');
  await expect(page.getByRole('img', { name: 'QR code of the invitation' })).toBeVisible();
  const users = page.getByRole('region', { name: 'Users' });
  await users.getByRole('button', { name: 'New user' }).click();
  await users.getByRole('button', { name: 'New token' }).click();
  await users.getByLabel('What for').fill('weather');
  await users.getByRole('button', { name: 'Make the token' }).click();
  await expect(users.getByRole('list', { name: 'All tokens' })).toContainText('weather');
  await users.getByRole('button', { name: 'New token' }).click();
  const audit = page.getByRole('region', { name: 'Who did what' });
  await audit.getByRole('button', { name: 'Search' }).click();
  await look('invitation, users, tokens, audit');

  // and comes back by PIN, by password and with an invitation,
  await press(page, 'Log out');
  await expect(page.getByRole('form', { name: 'Log in by PIN' })).toBeVisible();
  await look('PIN');
  await expect_stop_in_sight(page);
  await press(page, 'I have an invitation');
  await look('invited');
  await expect_stop_in_sight(page);
  await press(page, 'Use the password instead');
  await look('password');
  // also on a phone on its side, where the form is longer than the screen.
  await press(page, 'Use the PIN instead');
  await page.setViewportSize({ width: 844, height: 390 });
  await expect_stop_in_sight(page);
  expect(found).toEqual([]);
});
