// A PIN instead of the password, as gloves want it, and the invitation of another phone.

import { make_first_admin, press, tab } from './page';
import { expect, test } from './station';

test.use({
  more: ['--set', 'server.access=true'],
  viewport: { width: 390, height: 844 },
  hasTouch: true,
});

const PASSWORD = 'four tractors in a barn';

test('a phone is paired, opens by its PIN, invites another one and sends it away', async ({
  page,
  browser,
  station,
}) => {
  const live = page.getByRole('group', { name: 'Link' });
  const digits = async (on: typeof page, pin: string) => {
    for (const digit of pin) await press(on, digit);
  };
  // Given an admin who logged in by password
  await make_first_admin(page, station, PASSWORD);

  // who pairs the phone, at first with a PIN that is too easy,
  await tab(page, 'Log');
  const card = page.getByRole('region', { name: 'My devices' });
  await press(page, 'Pair this device');
  await page.getByLabel('Name of this device').fill('glove phone');
  await digits(page, '1234');
  await press(page, 'OK: Pair');
  await expect(card.getByRole('alert')).toContainText('easy to guess');
  await digits(page, '2580');
  await press(page, 'OK: Pair');
  const pairings = card.getByRole('list', { name: 'Paired devices' });
  await expect(pairings).toContainText('glove phone (this device), admin');
  await press(page, 'Log out');

  // when the PIN is typed, once wrongly, on keys for gloves,
  await expect(page.getByRole('form', { name: 'Log in by PIN' })).toContainText('anna');
  const key = await page.getByRole('button', { name: '5', exact: true }).boundingBox();
  expect(key?.height).toBeGreaterThanOrEqual(56);
  expect(key?.width).toBeGreaterThanOrEqual(56);
  await digits(page, '8520');
  await press(page, 'OK: Log in by PIN');
  await expect(page.getByRole('alert')).toContainText('it may be tried 4 more times');
  await digits(page, '2580');
  await press(page, 'OK: Log in by PIN');
  await expect(live).toContainText('Live');

  // and another phone is invited, for less,
  await tab(page, 'Log');
  await press(page, 'Invite a phone');
  await page.getByLabel('What it may do').selectOption('operator');
  await press(page, 'Show a code');
  const picture = page.getByRole('img', { name: 'QR code of the invitation' });
  await expect(picture).toBeVisible();
  expect(await picture.evaluate((img: HTMLImageElement) => img.naturalWidth)).toBeGreaterThan(0);
  const code = await page.getByLabel('Code').innerText();
  const context = await browser.newContext({ viewport: { width: 390, height: 844 } });
  const other = await context.newPage();
  const asked: string[] = [];
  other.on('request', (request) => asked.push(request.url()));
  await other.goto(`${station.url}/#invite=${code}`);
  await expect(other.getByLabel('Code')).toHaveValue(code);
  expect(other.url()).not.toContain(code);
  await other.getByLabel('Name of this phone').fill('second phone');
  await digits(other, '1379');
  await press(other, 'OK: Pair this phone');

  // then it is in, as what was chosen, and its address was never sent;
  await expect(other.getByRole('group', { name: 'Link' })).toContainText('Live');
  expect(asked.join(' ')).not.toContain(code);
  await tab(other, 'Log');
  await expect(other.getByRole('region', { name: 'My devices' })).toContainText('anna, operator');

  // and when its pairing is ended, it is out, and its PIN opens nothing.
  await page.reload();
  await tab(page, 'Log');
  const second = pairings.getByRole('listitem').filter({ hasText: 'second phone' });
  await second.getByRole('button', { name: 'End the pairing' }).click();
  await expect(second).toHaveCount(0);
  await expect(other.getByRole('form', { name: 'Log in' })).toBeVisible({ timeout: 20_000 });
  await context.close();
});

test('a password is changed with the old one, and the other devices are out', async ({
  page,
  station,
}) => {
  const next = 'five tractors in a barn';
  await make_first_admin(page, station, PASSWORD);
  for (const device of ['tablet', 'old phone']) {
    await station.rest('POST', '/session', { user: 'anna', password: PASSWORD, device });
  }
  await tab(page, 'Log');
  const sessions = page.getByRole('list', { name: 'Where I am logged in' });
  await expect(sessions.getByRole('listitem')).toHaveCount(3);
  await press(page, 'Log out everywhere else');
  await expect(sessions.getByRole('listitem')).toHaveCount(1);
  await station.rest('POST', '/session', { user: 'anna', password: PASSWORD, device: 'tablet' });

  await press(page, 'Change password');
  const form = page.getByRole('form', { name: 'Change password' });
  await form.getByLabel('Old password').fill('wrong tractors');
  await form.getByLabel('New password').fill(next);
  await press(page, 'Change it');
  await expect(form.getByRole('alert')).toContainText('the old password is wrong');
  await form.getByLabel('Old password').fill(PASSWORD);
  await press(page, 'Change it');
  await expect(form).toHaveCount(0);
  await expect(sessions.getByRole('listitem')).toHaveCount(1);
  await station.rest('POST', '/session', { user: 'anna', password: next, device: 'tablet' });
});
