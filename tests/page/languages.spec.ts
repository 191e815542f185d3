// The page in the language of whoever holds the device: chosen once, seen at once, kept on it.

import type { Page } from '@playwright/test';

import { open_page, tab } from './page';
import { expect, test } from './station';

test.use({ viewport: { width: 390, height: 844 } });

const choose = (page: Page, name: string): Promise<unknown> =>
  page.getByLabel('Language').selectOption({ label: name });
const language_of = (page: Page): Promise<string> =>
  page.evaluate(() => document.documentElement.lang);
/** The narrowest phone, and one on its side. */
const NARROW = [
  { width: 360, height: 740 },
  { width: 844, height: 390 },
] as const;
const WORDS = [
  ...['header .cell > span:visible', '.deck dt', '.deck dd', '.deck button'],
  ...['.choice', '.choice span', '.choice button'],
].join(', ');
/** Words of the status, of the deck and of the settings that would be cut off or lie over others. */
const cut_off = async (page: Page): Promise<string[]> => {
  const found: string[] = [];
  for (const size of NARROW) {
    await page.setViewportSize(size);
    found.push(
      ...(await page
        .locator(WORDS)
        .evaluateAll((all) =>
          all
            .filter((each) => each.scrollWidth > each.clientWidth + 1)
            .map((each) => `${each.textContent.trim()} at ${innerWidth}`),
        )),
    );
  }
  await page.setViewportSize({ width: 390, height: 844 });
  return found;
};
const panel = (page: Page, at: number): Promise<void> =>
  page.getByRole('navigation').getByRole('button').nth(at).click();

test('Finnish is chosen, said at once, and still spoken after a reload', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  expect(await language_of(page)).toBe('en');
  await tab(page, 'Log');

  await choose(page, 'Suomi');

  await expect(page.getByRole('heading', { name: 'Tapahtumat' })).toBeVisible();
  await expect(page.getByRole('group', { name: 'Yhteys' })).toContainText('Live');
  const up = page.getByRole('listitem').filter({ hasText: 'Laiteajuri toimii.' }).first();
  await expect(up.locator('[lang=en]')).toHaveCount(0);
  await expect(up).toContainText(/toimii\.\s+\S+ toimii/);
  expect(await language_of(page)).toBe('fi');
  await panel(page, 0);
  await expect(page.getByRole('button', { name: 'Aktivoi' })).toBeVisible();
  // So are figures, the map's own words and the titles of events, and what the robot says of them.
  await expect(page.locator('#map')).toHaveAttribute('aria-label', 'Kartta');
  await expect(page.locator('.scale-bar')).toHaveAttribute('aria-label', /^Mittakaava/);
  await expect(page.getByRole('group', { name: 'Nopeus, m/s' })).toContainText('0,00');
  // The word on the stop button is the same for everybody, and it is part of its name.
  await expect(page.getByRole('button', { name: /^STOP/ })).toHaveText('STOP');

  await page.reload();
  await expect(page.getByRole('button', { name: 'Aktivoi' })).toBeVisible();
  await panel(page, 1);
  await expect(page.getByRole('heading', { name: 'Reitit' })).toBeAttached();
  expect(await language_of(page)).toBe('fi');
});

test('why the robot does not do as it is told is said in the language that is chosen', async ({
  page,
  station,
}) => {
  // A refusal stays as it was told: the language is there with all of its sentences, or not yet.
  await page.route(/\/assets\/late-/, async (route) => {
    await new Promise((done) => setTimeout(done, 2000));
    return route.continue();
  });
  await open_page(page, station.url);
  await station.rest('POST', '/vehicle/estop', {});
  await tab(page, 'Log');
  await choose(page, 'Suomi');
  // A check, and what is wrong in a file, each by its sentence.
  await expect(page.getByText('hätäseis on lukittuna: kuittaa se ensin').first()).toBeVisible();
  const file = { name: 'a.csv', mimeType: 'text/csv', buffer: Buffer.from('lat,lon\n95,26.7\n') };
  await panel(page, 2);
  await page.locator('input[type=file]').first().setInputFiles(file);
  await expect(page.getByRole('log')).toContainText('rivi 2 leveysasteen on oltava');
});

test('in every language the panels fit a phone, and no text is missing', async ({
  page,
  station,
}) => {
  test.setTimeout(90_000);
  await open_page(page, station.url);
  for (const [language, name] of [
    ['fi', 'Suomi'],
    ['et', 'Eesti'],
    ['it', 'Italiano'],
    ['nb', 'Norsk'],
    ['en', 'English'],
  ] as const) {
    await panel(page, 3);
    await choose(page, name);
    await expect.poll(() => language_of(page)).toBe(language);
    for (const at of [3, 2, 1, 0]) {
      if (at !== 3) await panel(page, at);
      expect.soft(await cut_off(page), `cut off in panel ${at} in ${name}`).toEqual([]);
      const seen = await page.evaluate(() => ({
        wide: document.documentElement.scrollWidth,
        keys: /\{\w+\}|\b[a-z]+(_[a-z]+){2,}\b/.exec(document.body.innerText)?.[0] ?? '',
      }));
      expect(seen, `panel ${at} in ${name}`).toEqual({ wide: 390, keys: '' });
    }
  }
});
