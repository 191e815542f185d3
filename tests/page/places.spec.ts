// Places in the words of others: read under the mouse, typed and pasted.

import { map_middle, metres_between, open_page, press, tab } from './page';
import { expect, test } from './station';

test('the place under the mouse is told in degrees, in minutes and seconds, and in UTM', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  const under = page.getByLabel('Under the pointer');
  await tab(page, 'Log');
  await press(page, '58.378°');
  const [x, y] = await map_middle(page);
  await page.mouse.move(x, y); // the robot stands there
  await expect(under).toHaveText(/^\d+\.\d{7}, \d+\.\d{7}$/);
  const [lat = NaN, lon = NaN] = (await under.innerText()).split(', ').map(Number);
  expect(metres_between({ lat, lon }, station.sim.now)).toBeLessThan(1);

  await press(page, '58°22′');
  await expect(under).toBeHidden(); // the mouse is on the button
  await page.mouse.move(x, y);
  await expect(under).toHaveText(/^\d+°\d\d′\d\d\.\d{3}″N \d+°\d\d′\d\d\.\d{3}″E$/);
  await press(page, 'UTM');
  await page.mouse.move(x, y);
  await expect(under).toHaveText(/^\d+[C-X] \d{6}\.\d\d \d+\.\d\d$/);
});

test('a pasted pair is shown on the map, ready to be driven to', async ({ page, station }) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await open_page(page, station.url);
  await press(page, 'Go to coordinates…');
  const field = page.getByRole('dialog').getByRole('textbox');
  await field.fill('somewhere');
  const read = page.getByRole('status', { name: 'Read as' });
  await expect(read).toHaveText('No place can be read in this.');
  const { lat, lon } = station.sim.now;
  // A thousandth of a degree to the north is 111 m.
  await field.fill(`${(lat + 0.001).toFixed(6)}N ${lon.toFixed(6)}E`);
  await expect(read).toContainText(/11[012] m away, 000° N|360° N/);
  await field.press('Enter');
  const card = page.getByLabel('Chosen place');
  await expect(card).toContainText(/11[012] m away/);
  await expect(card).toContainText(`${(lat + 0.001).toFixed(6)}`);
});
