// Who did what, for an admin: on a phone and on a laptop.

import type { Page } from '@playwright/test';

import { make_first_admin, press, tab } from './page';
import { expect, test } from './station';

test.use({ more: ['--set', 'server.access=true'] });

const PASSWORD = 'four tractors in a barn';

const card = (page: Page) => page.getByRole('region', { name: 'Who did what' });
const deeds = (page: Page) => page.getByRole('list', { name: 'Deeds' }).getByRole('listitem');

const enter = async (page: Page, user: string): Promise<void> => {
  await page.getByLabel('User', { exact: true }).fill(user);
  await page.getByLabel('Password').fill(PASSWORD);
  await press(page, 'Log in');
  await expect(page.getByRole('group', { name: 'Link' })).toContainText('Live');
};

/** A call of the page's own. */
const post = (page: Page, path: string, body: unknown): Promise<void> =>
  page.evaluate(
    async ({ to, text }) => {
      const headers = { 'Content-Type': 'application/json' };
      await fetch(`/api/v1${to}`, { method: 'POST', headers, body: text });
    },
    { to: path, text: JSON.stringify(body) },
  );

/** Makes and deletes so many missions: each deletion is a row of its own. */
const delete_many = (page: Page, count: number): Promise<void> =>
  page.evaluate(async (times) => {
    const body = '{"name":"field","items":[{"type":"waypoint","lat":58.378,"lon":26.7289}]}';
    const headers = { 'Content-Type': 'application/json' };
    for (let i = 0; i < times; i += 1) {
      const made = await fetch('/api/v1/missions', { method: 'POST', headers, body });
      const { id } = (await made.json()) as { id: string };
      const tag = { 'If-Match': made.headers.get('ETag') ?? '' };
      await fetch(`/api/v1/missions/${id}`, { method: 'DELETE', headers: tag });
    }
  }, count);

for (const [name, width, height] of [
  ['phone', 390, 844],
  ['laptop', 1440, 900],
] as const) {
  test.describe(name, () => {
    test.use({ viewport: { width, height } });

    test('an admin reads, searches, pages, checks and takes away', async ({ page, station }) => {
      // Given many deeds, of which one was refused,
      await make_first_admin(page, station, PASSWORD);
      await delete_many(page, 70);
      await post(page, '/users', { name: 'bert', role: 'viewer', password: 'short' });
      await tab(page, 'Log');
      // then a page of them is shown, the newest first,
      await expect(deeds(page)).toHaveCount(50);
      const refused = deeds(page).filter({ hasText: 'POST /users' });
      await expect(refused).toContainText('anna');
      await expect(refused).toContainText('refused');
      await expect(refused).toContainText('/password must have at least 12 characters');
      await expect(deeds(page).filter({ hasText: 'DELETE /missions' }).first()).toContainText(
        'done',
      );
      await card(page).scrollIntoViewIfNeeded();
      await page.screenshot({ path: `../tests/page/results/audit-${name}.png` });
      // more when asked for,
      await press(page, 'Show more');
      await expect.poll(() => deeds(page).count()).toBeGreaterThan(70);
      // all of it is as it was written, and can be taken away.
      await expect(card(page).getByRole('status')).toContainText('Whole: rows 1 to');
      const waiting = page.waitForEvent('download');
      await card(page)
        .getByRole('link', { name: /^Export rows 1 to/ })
        .click();
      const file = await waiting;
      expect(file.suggestedFilename()).toMatch(/^audit.*\.csv$/);

      // When it is searched, then what fits is left; nothing, where nothing fits.
      await card(page).getByRole('button', { name: 'Search' }).click();
      await card(page).getByLabel('Result').selectOption('refused');
      await press(page, 'Show these');
      await expect(deeds(page)).toHaveCount(1);
      await page.screenshot({ path: `../tests/page/results/audit-search-${name}.png` });
      await card(page).getByRole('textbox', { name: 'Who' }).fill('nobody at all');
      await press(page, 'Show these');
      await expect(deeds(page)).toHaveText(['Nothing of the kind.']);

      // When the robot cannot be reached, then that is said, and what was read stays.
      await card(page).getByRole('textbox', { name: 'Who' }).fill('anna');
      await press(page, 'Show these');
      await expect(deeds(page).first()).toContainText('POST /users');
      await page.context().setOffline(true);
      await press(page, 'Look again');
      await expect(card(page).getByRole('alert')).toContainText('The robot cannot be reached.');
      await expect(deeds(page).first()).toContainText('POST /users');
      await card(page).getByRole('button', { name: 'Check', exact: true }).click();
      await expect(card(page).getByRole('status')).toContainText('Not looked through');
      // Nothing lies beside the card.
      const wide = await card(page).evaluate((one) => one.scrollWidth - one.clientWidth);
      expect(wide).toBeLessThanOrEqual(0);
    });
  });
}

test('who is no admin does not find it', async ({ page, station }) => {
  await make_first_admin(page, station, PASSWORD);
  await post(page, '/users', { name: 'bert', role: 'operator', password: PASSWORD });
  await tab(page, 'Log');
  await expect(card(page)).toBeVisible();
  await press(page, 'Log out');
  await enter(page, 'bert');
  await tab(page, 'Log');
  await expect(page.getByRole('region', { name: 'My devices' })).toBeVisible();
  await expect(card(page)).toHaveCount(0);
});
