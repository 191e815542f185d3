// Files with something wrong: the rest is taken when the person says so, and a refusal goes with what is
// done next.

import { items, open_page, press, tab } from './page';
import { expect, test } from './station';

const csv = (name: string, rows: string) => ({
  name,
  mimeType: 'text/csv',
  buffer: Buffer.from(`lat,lon\n${rows}`),
});

test('of a file with one wrong place the rest is taken, and the report names what is left out', async ({
  page,
  station,
}) => {
  await page.goto(station.url);
  await tab(page, 'Missions');
  const file = csv('field.csv', '58.378,26.7289\n95,26.729\n58.3785,26.729\n');
  await page.getByLabel('Mission file').setInputFiles(file);
  const dialog = page.getByRole('dialog');
  await expect(dialog).toContainText('line 3: latitude must be from -90 to 90, is 95');
  // Whoever does not want that has nothing of it.
  await press(page, 'Cancel');
  await expect(page.getByText('No missions stored yet.')).toBeVisible();

  await page.getByLabel('Mission file').setInputFiles(file);
  await press(page, 'Take the rest');
  await expect(dialog).toContainText('field.csv');
  const report = dialog.getByRole('list', { name: 'Report' });
  await expect(report.getByRole('listitem')).toHaveCount(1);
  await expect(report).toContainText('line 3');
  await expect(report).toContainText('is 95');
  await press(page, 'Continue');
  await tab(page, 'Plan');
  await expect(items(page)).toHaveCount(2);
});

test('on a phone a refused file is told until it is dismissed, or until what is done next', async ({
  page,
  station,
}) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await open_page(page, station.url);
  await tab(page, 'Missions');
  const messages = page.getByLabel('Messages');
  const refuse = async (name: string): Promise<void> => {
    await page.getByLabel('Mission file').setInputFiles([csv(name, '95,26.729\n')]);
    await expect(messages).toContainText(`“${name}” was not imported`);
  };
  await refuse('one.csv');
  const refused = messages.locator('.notice', { hasText: 'one.csv' }); // the robot may say something, too
  await refused.getByRole('button', { name: 'Dismiss' }).click();
  await expect(messages).not.toContainText('one.csv');

  await refuse('two.csv');
  await tab(page, 'Plan');
  await expect(messages).not.toContainText('two.csv');

  // One of several: the file behind it is not what the person does next.
  await tab(page, 'Missions');
  await page
    .getByLabel('Mission file')
    .setInputFiles([
      csv('bad.csv', '95,26.729\n'),
      csv('good.csv', '58.378,26.729\n58.379,26.729\n'),
    ]);
  await press(page, 'Continue');
  await expect(messages).toContainText('“bad.csv” was not imported');
});

test('a report is read in the language that is chosen, as soon as its sentences have come', async ({
  page,
  station,
}) => {
  // They come behind the page itself. Where the network does not let them through, they are asked for again.
  let comes = false;
  let asked = 0;
  await page.route(/\/assets\/late-[^/]*\.js$/, (route) => {
    asked += 1;
    return comes ? route.continue() : route.abort();
  });
  await open_page(page, station.url);
  await tab(page, 'Log');
  expect(asked, 'English needs none').toBe(0);
  await page.getByLabel('Language').selectOption('fi');
  const file = {
    name: 'from_the_air.waypoints',
    mimeType: 'text/plain',
    buffer: Buffer.from(
      [
        'QGC WPL 110',
        '0\t1\t0\t16\t0\t0\t0\t0\t58.378\t26.7289\t0\t1',
        '1\t0\t3\t22\t0\t0\t0\t0\t58.378\t26.7289\t10\t1',
        '2\t0\t3\t16\t0\t0\t0\t0\t58.3785\t26.729\t0\t1',
        '3\t0\t3\t16\t0\t0\t0\t0\t58.379\t26.729\t0\t1',
        '',
      ].join('\n'),
    ),
  };
  const panel = (at: number): Promise<void> =>
    page.getByRole('navigation').getByRole('button').nth(at).click();
  const report = page.getByRole('dialog').getByRole('listitem');
  await panel(2);
  await page.locator('input[type=file]').first().setInputFiles(file);
  await expect(report.filter({ hasText: 'a ground vehicle does not take off' })).toBeVisible();
  expect(asked).toBeGreaterThan(0);

  comes = true;
  await expect(report.filter({ hasText: 'maa-ajoneuvo ei nouse ilmaan' })).toBeVisible();
  await press(page, 'Jatka');

  await panel(3);
  await page.getByLabel('Language').selectOption('et');
  await panel(2);
  await page.locator('input[type=file]').first().setInputFiles(file);
  await expect(report.filter({ hasText: 'maasõiduk ei tõuse õhku' })).toBeVisible();
});
