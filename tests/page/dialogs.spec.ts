// Dialogs by the keyboard: the focus stays in them, but for the stop button, and goes back.

import { open_page, press, tab } from './page';
import { expect, test } from './station';

test('Tab goes round in a dialog and by the stop button, and the focus comes back', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  await tab(page, 'Log');
  await press(page, 'Keys');
  const dialog = page.getByRole('dialog');
  await expect(dialog).toBeFocused();
  const close = dialog.getByRole('button', { name: 'Close' });
  const stop = page.getByRole('button', { name: 'Emergency stop' });
  for (let round = 0; round < 2; round += 1) {
    await page.keyboard.press('Tab');
    await expect(close).toBeFocused();
    await page.keyboard.press('Tab');
    await expect(stop).toBeFocused();
  }
  await page.keyboard.press('Shift+Tab');
  await expect(close).toBeFocused();
  await page.keyboard.press('Enter');
  await expect(dialog).toBeHidden();
  await expect(page.getByRole('button', { name: 'Keys', exact: true })).toBeFocused();
});
