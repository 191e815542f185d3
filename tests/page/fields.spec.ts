// A field that is drawn becomes a mission; a fence that is drawn holds the robot.

import { arm, draw, items, map_middle, open_page, press, tab, type Point } from './page';
import { expect, test } from './station';

interface Fence {
  readonly name: string;
  readonly areas: readonly {
    readonly kind: string;
    readonly polygon?: readonly Point[];
    readonly circle?: { readonly radius_m: number };
  }[];
  readonly rally: readonly Point[];
}

const SQUARE = [
  [-100, -60],
  [100, -60],
  [100, 60],
  [-100, 60],
] as const;

test('a field is drawn, its tracks are shown with figures, and it is kept as a mission', async ({
  page,
  station,
}) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await open_page(page, station.url);
  await tab(page, 'Plan');
  await press(page, 'Cover a field…');
  await expect(page.getByText('Tap the corners of the field on the map.')).toBeVisible();
  await draw(page, SQUARE);
  const figures = page.getByLabel('Survey', { exact: true });
  await expect(figures).toContainText(/(9\d|100)\.\d %/);
  const before = await figures.innerText();
  await page.getByLabel('Working width, m').fill('2');
  await page.getByLabel('Working width, m').press('Enter');
  await expect.poll(() => figures.innerText()).not.toBe(before);

  // The bad corner comes off again, a bad number is said.
  await draw(page, [[0, 0]]);
  await press(page, 'Undo');
  await page.getByLabel('Rounds along the border').fill('1.5');
  await page.getByLabel('Rounds along the border').press('Enter');
  await expect(page.getByText('Rounds along the border must be a whole number.')).toBeVisible();

  await page.getByLabel('Name of the mission').fill('Meadow');
  await press(page, 'Keep as a mission');
  await expect(page.getByLabel('Mission name')).toHaveValue('Meadow');
  expect(await items(page).count()).toBeGreaterThan(4);
  const list = await station.rest<{ items: { name: string }[] }>('GET', '/missions');
  expect(list.items.map(({ name }) => name)).toEqual(['Meadow']);
});

test('a fence is drawn with a hole and a rally point, and then refuses what leaves it', async ({
  page,
  station,
}) => {
  test.setTimeout(120_000);
  await page.setViewportSize({ width: 390, height: 844 });
  await open_page(page, station.url);
  await tab(page, 'Missions');
  await press(page, 'Fences');
  await press(page, 'New fence');
  await page.getByLabel('Fence name').fill('Yard');
  await page.getByLabel('Fence name').press('Enter');
  await press(page, '+ Stay inside');
  // Off and on again: the robot stands in the middle.
  await press(page, 'Follow the robot');
  await press(page, 'Follow the robot');
  await draw(page, SQUARE);
  await expect(page.getByLabel('Parts of the fence')).toContainText('4 corners');
  await press(page, '+ Keep-out circle');
  await draw(page, [[70, 30]]);
  await page.getByLabel('Radius, m').fill('1');
  await page.getByLabel('Radius, m').press('Enter');
  await page.getByRole('button', { name: /^Rally points/ }).click();
  await draw(page, [[-60, 0]]);
  await press(page, 'Save');
  await expect(page.getByLabel('Messages')).toContainText('Saved the fence “Yard”.');

  const { items: stored } = await station.rest<{ items: { id: string }[] }>('GET', '/fences');
  const fence = await station.rest<Fence>('GET', `/fences/${stored[0]?.id ?? ''}`);
  expect(fence.areas.map(({ kind }) => kind)).toEqual(['inclusion', 'exclusion']);
  expect(fence.areas[0]?.polygon).toHaveLength(4);
  expect(fence.areas[1]?.circle?.radius_m).toBe(1);
  expect(fence.rally).toHaveLength(1);

  await press(page, 'All fences');
  await press(page, 'Use it');
  await expect(page.getByLabel('Fences')).toContainText('the robot keeps to it');
  await tab(page, 'Drive');
  await expect(page.getByLabel('Fence', { exact: true })).toContainText('Yard');
  await arm(page);
  await page.getByRole('button', { name: 'Zoom out' }).click();
  await page.waitForTimeout(400); // the zoom is animated
  const [x, y] = await map_middle(page);
  await page.mouse.click(x + 120, y);
  await press(page, 'Go here');
  await expect(page.getByRole('alert', { name: 'Refused' })).toContainText(
    'the way there leaves the fence',
  );
});
