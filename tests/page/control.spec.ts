// Two browsers and one robot: one drives, the other watches, asks, and takes it by force.

import type { Browser, Page } from '@playwright/test';

import { press, tab } from './page';
import { expect, test } from './station';

test.use({ more: ['--set', 'server.access=true'] });

const PASSWORD = 'four tractors in a barn';

const control = (page: Page) => page.getByRole('region', { name: 'Control' });

const enter = async (page: Page, url: string, user: string): Promise<void> => {
  await page.goto(url);
  await page.getByLabel('User', { exact: true }).fill(user);
  await page.getByLabel('Password').fill(PASSWORD);
  await press(page, 'Log in');
  await expect(page.getByRole('group', { name: 'Link' })).toContainText('Live');
};

const another = async (browser: Browser, url: string, user: string): Promise<Page> => {
  const page = await (await browser.newContext()).newPage();
  await enter(page, url, user);
  return page;
};

test('control is taken, asked for, handed over, and taken by force', async ({
  page: anna,
  browser,
  station,
}) => {
  // given: anna, the admin, and ben, an operator
  await anna.goto(station.url);
  await anna.getByLabel('Code').fill(await station.code());
  await anna.getByLabel('User', { exact: true }).fill('anna');
  await anna.getByLabel('Password').fill(PASSWORD);
  await press(anna, 'Make the first admin');
  await expect(control(anna)).toContainText('Nobody has control');
  // On a tablet it takes one line from the map.
  await anna.setViewportSize({ width: 820, height: 1180 });
  await expect.poll(async () => (await control(anna).boundingBox())?.height).toBeLessThan(75);
  await anna.setViewportSize({ width: 1440, height: 900 });
  const made = await anna.evaluate(async (password) => {
    const answers: number[] = [];
    for (const [name, role] of Object.entries({
      ben: 'operator',
      cleo: 'viewer',
    })) {
      const answer = await fetch('/api/v1/users', {
        method: 'POST',
        headers: { 'Content-Type': 'application/json' },
        body: JSON.stringify({ name, role, password }),
      });
      answers.push(answer.status);
    }
    return answers;
  }, PASSWORD);
  expect(made).toEqual([201, 201]);
  const ben = await another(browser, station.url, 'ben');

  // when: anna takes it; then both see so
  await press(anna, 'Take control');
  await expect(control(anna)).toContainText('You have control');
  await expect(control(ben)).toContainText('anna');
  await expect(control(ben)).toContainText('has control');

  // and: what he may not do says so before it is pressed
  await expect(ben.getByRole('button', { name: 'Arm', exact: true })).toHaveAttribute(
    'title',
    /has control: ask for it first/,
  );

  // and: a viewer sees it, and is offered nothing
  const cleo = await another(browser, station.url, 'cleo');
  await expect(control(cleo)).toContainText('has control');
  await expect(control(cleo)).toContainText('You watch, and may stop.');
  // … but who else is connected.
  await expect(control(cleo).getByRole('button')).toHaveCount(1);
  await press(cleo, 'Who is here');
  const here = control(cleo).getByRole('list', { name: 'Who is here' }).getByRole('listitem');
  await expect(here).toHaveCount(3);
  await expect(here.first()).toContainText('anna');
  await expect(here.first()).toContainText('has control');
  await expect(here.filter({ hasText: 'cleo' })).toContainText('that is you');

  // … and what would store something says so before it is pressed.
  await tab(cleo, 'Missions');
  for (const [shelf, names] of [
    ['Missions', ['New', 'Import']],
    ['Fences', ['New fence']],
    ['Maps', ['Add a map', 'Add MBTiles or GeoTIFF']],
  ] as const) {
    await cleo.getByRole('main').getByRole('button', { name: shelf, exact: true }).click();
    for (const name of names) {
      const button = cleo.getByRole('button', { name, exact: true });
      await expect(button).toHaveAttribute('title', /Your role is viewer/);
    }
  }
  await tab(cleo, 'Drive');

  // when: ben asks, and anna keeps it
  await press(ben, 'Ask');
  const question = anna.getByRole('alertdialog', {
    name: 'Somebody asks for control',
  });
  await expect(question).toContainText('ben');
  await question.getByRole('button', { name: 'Keep' }).click();
  await expect(control(ben).getByRole('alert')).toContainText('keeps control');
  await expect(question).toHaveCount(0);

  // when: he asks again, and she hands it over
  await press(ben, 'Ask');
  await question.getByRole('button', { name: 'Hand over' }).click();
  await expect(control(ben)).toContainText('You have control');
  await expect(control(anna)).toContainText('ben');

  // when: she takes it back by force; then he reads why
  await press(cleo, 'Who is here');
  await press(cleo, 'Who is here');
  await expect(here.filter({ hasText: 'has control' })).toContainText('ben');
  await press(anna, 'Force …');
  await anna.getByLabel('Why, for everyone to read').fill('the gate is open');
  await press(anna, 'Take it by force');
  await expect(control(anna)).toContainText('You have control');
  // … and a list that is open says so at once, too.
  await expect(here.filter({ hasText: 'has control' })).toContainText('anna', { timeout: 2000 });
  await expect(control(ben).getByRole('alert')).toContainText('by force: the gate is open');

  // Anyone may stop.
  await press(ben, 'Emergency stop');
  await expect(anna.getByText('Emergency stop is latched.')).toBeVisible();

  // On a phone all of it leaves a strip of the map, and is said once.
  await ben.setViewportSize({ width: 390, height: 844 });
  await expect(ben.getByText('Emergency stop is latched.')).toBeVisible();
  await expect(ben.getByRole('log', { name: 'Messages' })).not.toContainText('by force');
  const strip_px = async (): Promise<number> => {
    const head = await ben.locator('header').boundingBox();
    const panel = await ben.locator('#panel').boundingBox();
    return head && panel ? panel.y - (head.y + head.height) : 0;
  };
  await expect.poll(strip_px).toBeGreaterThan(100);

  // when: anna's page is gone; then it is free after the grace, by itself
  await anna.close();
  await expect(control(ben)).toContainText('Nobody has control', {
    timeout: 40_000,
  });
  await press(ben, 'Take control');
  await expect(control(ben)).toContainText('You have control');
});
