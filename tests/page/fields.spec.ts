// A field that is drawn becomes a mission; a fence that is drawn holds the robot.

import {
  arm,
  draw,
  extent_px,
  items,
  map_pixels,
  mark,
  open_page,
  pixels_per_m,
  press,
  tab,
  type Color,
  type Point,
} from './page';
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

  // Rounds along the border have no tracks, and lead nowhere in particular.
  await page.getByLabel('Pattern').selectOption('Along the border');
  await expect(figures).not.toContainText(/Tracks|Direction/);
  await expect(page.getByLabel(/^Direction/)).toHaveCount(0);
  await page.getByLabel('Pattern').selectOption('Tracks');
  await expect(figures).toContainText(/Tracks/);

  // The bad corner comes off again, a bad number is said.
  await draw(page, [[0, 0]]);
  await press(page, 'Undo');
  await page.getByLabel('Rounds along the border').fill('1.5');
  await page.getByLabel('Rounds along the border').press('Enter');
  await expect(page.getByText('Rounds along the border must be a whole number.')).toBeVisible();

  // Nothing is kept by a number that no field shows.
  await page.getByLabel('Name of the mission').fill('Meadow');
  await press(page, 'Keep as a mission');
  await expect(page.getByText('A field is wrong')).toBeVisible();
  await expect(page.getByLabel('Rounds along the border')).toBeFocused();
  await page.getByLabel('Rounds along the border').fill('0');
  await page.getByLabel('Rounds along the border').press('Enter');
  await press(page, 'Keep as a mission');
  await expect(page.getByLabel('Mission name')).toHaveValue('Meadow');
  expect(await items(page).count()).toBeGreaterThan(4);
  const list = await station.rest<{ items: { name: string }[] }>('GET', '/missions');
  expect(list.items.map(({ name }) => name)).toEqual(['Meadow']);

  // It stays one object: changed later, also after a reload, its points follow, as one step.
  await page.reload();
  await tab(page, 'Plan');
  const all = await items(page).count();
  await press(page, 'Change the field…');
  await expect(page.getByLabel('Working width, m')).toHaveValue('2');
  // Nothing changed is nothing to save.
  await expect(page.getByLabel('Survey', { exact: true })).toContainText('%');
  await press(page, 'Change the mission');
  await expect(page.getByLabel('Summary')).toContainText('saved, revision 1');
  await press(page, 'Change the field…');
  await page.getByLabel('Working width, m').fill('4');
  await page.getByLabel('Working width, m').press('Enter');
  await expect(page.getByText('The points of “Meadow” follow')).toBeVisible();
  await press(page, 'Change the mission');
  await expect(page.getByLabel('Summary')).toContainText('saved, revision 2');
  expect(await items(page).count()).toBeLessThan(all);
  await press(page, 'Undo');
  await expect(items(page)).toHaveCount(all);
  await press(page, 'Change the field…');
  await expect(page.getByLabel('Working width, m')).toHaveValue('2');
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
  const told = page.getByLabel('Messages');
  await expect(told).toContainText('Saved the fence “Yard”. The robot does not keep to it');

  const { items: stored } = await station.rest<{ items: { id: string }[] }>('GET', '/fences');
  const fence = await station.rest<Fence>('GET', `/fences/${stored[0]?.id ?? ''}`);
  expect(fence.areas.map(({ kind }) => kind)).toEqual(['inclusion', 'exclusion']);
  expect(fence.areas[0]?.polygon).toHaveLength(4);
  expect(fence.areas[1]?.circle?.radius_m).toBe(1);
  expect(fence.rally).toHaveLength(1);

  await press(page, 'All fences');
  await press(page, 'Use it');
  await expect(page.getByLabel('Fences')).toContainText('the robot keeps to it');
  await expect(told).not.toContainText('does not keep to it');
  await tab(page, 'Drive');
  await expect(page.getByLabel('Fence', { exact: true })).toContainText('Yard');
  await arm(page);
  await page.getByRole('button', { name: 'Zoom out' }).click();
  await page.waitForTimeout(400); // the zoom is animated
  await mark(page, 120 / (await pixels_per_m(page)), 0);
  await press(page, 'Go here');
  await expect(page.getByRole('alert', { name: 'Refused' })).toContainText(
    'the way there leaves the fence',
  );
});

interface Rows {
  readonly name: string;
  readonly items: readonly {
    readonly type: string;
    readonly lat?: number;
    readonly lon?: number;
    readonly heading_deg?: number;
    readonly turn_deg?: number;
  }[];
}

test('a block of rows is begun with two taps, seen with its turns, and kept as a mission', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  await tab(page, 'Plan');
  await press(page, 'Block of rows…');
  await expect(page.getByText('Tap the map where row 1 begins.')).toBeVisible();
  await draw(page, [[-100, 50]]);
  await expect(page.getByText('Tap where row 1 ends.')).toBeVisible();
  await draw(page, [[-100, -150]]); // to the north
  const figures = page.getByLabel('Block of rows', { exact: true });
  await expect(figures).toContainText('1 2 3 4 5 6');
  await page.getByLabel('Rows to drive').fill('5');
  await page.getByLabel('Rows left out each time').fill('1');
  await page.getByLabel('Row 2 lies').selectOption('Right');
  await page.getByLabel('Row 2 lies').press('Enter');
  await expect(figures).toContainText('1 3 5 2 4');

  // What is chosen can be read on a tablet, too, where the panel is narrowest.
  await page.setViewportSize({ width: 820, height: 1180 });
  const cut = await page.locator('.fields select').evaluateAll((all) =>
    all.flatMap((each) => {
      const pen = document.createElement('canvas').getContext('2d');
      const chosen = (each as HTMLSelectElement).selectedOptions[0]?.text ?? '';
      if (!pen) return ['no canvas'];
      pen.font = getComputedStyle(each).font;
      return pen.measureText(chosen).width > each.clientWidth - 32 ? [chosen] : [];
    }),
  );
  expect(cut).toEqual([]);
  await page.setViewportSize({ width: 1440, height: 900 });

  // Five rows side by side to the right of the first, on which the drawn line lies: 10 m, and as
  // long as that one.
  const scale = await pixels_per_m(page);
  const ROW: Color = [184, 80, 10];
  const drawn = async () => extent_px(await map_pixels(page, [ROW], 2));
  await expect.poll(async () => (await drawn())[0] / scale).toBeGreaterThan(7);
  const [wide, high] = await drawn();
  expect(wide / scale).toBeLessThan(10.5);
  expect(high).toBeGreaterThan(190);
  expect(high).toBeLessThan(210);

  // A further tap turns it; the exact direction is typed.
  await draw(page, [[50, 50]]);
  await expect(figures).toContainText('90°');
  await page.getByLabel('Direction of row 1, deg').fill('45');
  await page.getByLabel('Direction of row 1, deg').press('Enter');
  await expect(figures).toContainText('45°');
  await page.getByLabel('Name of the mission').fill('East block');
  await press(page, 'Keep as a mission');
  await expect(page.getByLabel('Mission name')).toHaveValue('East block');
  const list = await station.rest<{ items: { id: string }[] }>('GET', '/missions');
  const made = await station.rest<Rows>('GET', `/missions/${list.items[0]?.id ?? ''}`);
  expect(made.items.filter(({ type }) => type === 'row')).toHaveLength(5);
  expect(made.items[0]).toMatchObject({ type: 'waypoint' });
  expect(made.items[1]?.heading_deg).toBeCloseTo(45, 1);
  // Out of row 1 it turns to where row 3 lies.
  expect(made.items[4]).toMatchObject({ type: 'turn', turn_deg: 90 });
  // As long as it is seen to be: the list tells no length of it.
  await tab(page, 'Missions');
  await expect(page.getByRole('list', { name: 'Stored missions' })).toContainText(
    /East block\s*\d+ items · revision 1/,
  );
});
