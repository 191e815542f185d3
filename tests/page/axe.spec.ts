// What reads the page aloud, and who sees little: axe looks at the views and dialogs of a robot that asks
// nobody who he is.

import { faults, faults_in_sunlight } from './axe';
import { draw, open_page, press, save, tab } from './page';
import { expect, test } from './station';

const LOOKS = [
  { name: 'phone, light', width: 390, height: 844, dark: false },
  { name: 'laptop, dark', width: 1440, height: 900, dark: true },
] as const;

for (const { name, width, height, dark } of LOOKS) {
  test(`axe finds nothing on the views and dialogs: ${name}`, async ({ page, station }) => {
    test.setTimeout(180_000);
    await page.setViewportSize({ width, height });
    await page.emulateMedia({ colorScheme: dark ? 'dark' : 'light' });
    await open_page(page, station.url);
    const found: string[] = [];
    const look = async (where: string): Promise<void> => {
      found.push(...(await faults(page, where)));
      if (!dark) found.push(...(await faults_in_sunlight(page, where)));
    };
    const main = page.locator('main');

    await look('Drive');
    await press(page, 'More…');
    await look('modes');
    await page.keyboard.press('Escape');

    await tab(page, 'Plan');
    await look('Plan, empty');
    await draw(page, [
      [-80, -60],
      [60, -80],
      [70, 40],
    ]);
    await save(page);
    await look('Plan');
    await main.getByRole('list', { name: 'Items' }).getByRole('button').first().click();
    await look('Plan, an item');
    await press(page, 'Select several');
    await look('Plan, several');
    await press(page, 'Select several');
    await press(page, 'Revisions…');
    await look('Plan, revisions');
    await press(page, 'Measure');
    await look('Measure');
    await main.getByRole('button', { name: 'Plan' }).click();
    await press(page, 'Cover a field…');
    await look('Survey');

    await tab(page, 'Missions');
    for (const shelf of ['Missions', 'Runs', 'Fences', 'Maps']) {
      await main.getByRole('button', { name: shelf, exact: true }).click();
      await look(shelf);
    }

    await tab(page, 'Log');
    for (const more of [
      'Vehicle profile',
      'Landmarks, walls, tags',
      'Parameters…',
      'About roverd',
    ]) {
      await main.getByRole('button', { name: more, exact: true }).click();
    }
    await expect(main.getByRole('region', { name: 'Vehicle profile' })).toContainText('Bunker');
    await expect(main.getByText('None is known.')).toBeVisible();
    await expect(main.getByRole('region', { name: 'About roverd' })).toContainText('MPL-2.0');
    await look('Log');
    await press(page, 'Keys');
    await look('keys');
    await page.keyboard.press('Escape');
    await tab(page, 'Drive');
    await press(page, 'Go to coordinates…');
    await look('a place');
    await page.keyboard.press('Escape');
    expect(found).toEqual([]);
  });
}
