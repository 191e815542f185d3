// The robot's parameters: found, changed, taken back, saved to a file and compared with one.

import { readFileSync } from 'node:fs';

import { open_page, press, tab } from './page';
import { expect, test } from './station';

for (const [name, viewport] of [
  ['phone', { width: 390, height: 844 }],
  ['laptop', { width: 1440, height: 900 }],
] as const) {
  test(`on a ${name} a parameter is found, changed and compared with a file`, async ({
    page,
    station,
  }) => {
    const stored = async (of: string): Promise<Record<string, unknown>> =>
      station.rest<Record<string, unknown>>('GET', `/parameters/${of}`);
    await page.setViewportSize(viewport);
    await open_page(page, station.url);
    await tab(page, 'Log');
    await press(page, 'Parameters…');
    const card = page.getByRole('region', { name: 'Parameters' });
    await card.getByRole('searchbox', { name: 'Search' }).fill('track damping');
    const damping = card.getByRole('listitem', { name: 'nav.track.damping' });
    const before = (await stored('nav.track.damping'))['value'];
    const waiting = page.waitForEvent('download');
    await press(page, 'Save to a file');
    const saved = readFileSync(await (await waiting).path(), 'utf8');

    // What does not fit is not sent, and said.
    const field = damping.getByRole('textbox');
    await field.fill('9999');
    await field.press('Enter');
    await expect(damping.getByRole('status')).toContainText('Not changed: it must be in');
    await expect(field).toHaveValue(String(before));
    await field.fill('1.2');
    await field.press('Enter');
    await expect(damping.getByRole('status')).toHaveText('It acts now.');
    expect((await stored('nav.track.damping'))['value']).toBe(1.2);

    // What acts at the next start tells what holds until then.
    await card.getByRole('searchbox', { name: 'Search' }).fill('vehicle.width');
    const width = card.getByRole('listitem', { name: 'vehicle.width_m' });
    await width.getByRole('textbox').fill('0.9');
    await width.getByRole('textbox').press('Enter');
    await expect(width).toContainText('Until the next start it is');
    await card.getByRole('searchbox', { name: 'Search' }).fill('');
    await card.getByRole('checkbox', { name: /differ from their defaults/ }).check();
    await expect(damping).toBeVisible();
    await expect(width).toBeVisible();
    await page.screenshot({ path: `../tests/page/results/parameters-${name}.png` });

    // The file of before tells what differs, and brings it back.
    await card.getByLabel('File of parameters').setInputFiles({
      name: 'parameters.json',
      mimeType: 'application/json',
      buffer: Buffer.from(saved),
    });
    const file = card.getByRole('group', { name: 'The file' });
    await expect(file).toContainText('2 differences');
    await expect(file).toContainText('nav.track.damping: 1.2');
    await file.getByRole('button', { name: 'Take them' }).click();
    await expect(file).toHaveCount(0);
    expect((await stored('nav.track.damping'))['value']).toBe(before);
  });
}
