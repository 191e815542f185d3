// Places in the words of others: read under the mouse, typed and pasted.

import {
  draw,
  items,
  map_middle,
  metres_between,
  open_page,
  pixels_per_m,
  press,
  tab,
} from './page';
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

test('a line is measured leg by leg, and the mission stays as it is', async ({ page, station }) => {
  await open_page(page, station.url);
  await tab(page, 'Plan');
  await press(page, 'Measure');
  const scale = await pixels_per_m(page);
  await draw(page, [
    [-100, 60],
    [-100, -60],
    [60, -60],
  ]);
  const legs = page.getByRole('list', { name: 'Legs' }).getByRole('listitem');
  await expect(legs).toHaveCount(2);
  const figures = async (): Promise<number[]> =>
    (await legs.allInnerTexts()).map((text) => Number.parseFloat(text));
  const [north = NaN, east = NaN] = await figures();
  expect(Math.abs(north - 120 / scale)).toBeLessThan(0.1);
  expect(Math.abs(east - 160 / scale)).toBeLessThan(0.1);
  await expect(legs.first()).toContainText('000° N');
  await expect(legs.last()).toContainText('090° E');
  const measured = page.getByLabel('Measured', { exact: true });
  await expect(measured).toContainText(`${(0.5 * north * east).toFixed(0)} m²`);
  // A point is moved like that of a mission.
  const [x, y] = await map_middle(page);
  await page.mouse.move(x + 60, y - 60);
  await page.mouse.down();
  await page.mouse.move(x + 160, y - 60, { steps: 5 });
  await page.mouse.up();
  await expect.poll(async () => (await figures())[1]).toBeCloseTo(260 / scale, 0);
  await press(page, 'Undo');
  await expect.poll(async () => (await figures())[1]).toBeCloseTo(160 / scale, 0);
  await page.locator('main').getByRole('button', { name: 'Plan' }).click();
  await expect(items(page)).toHaveCount(0);
});
