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
