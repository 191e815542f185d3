// Several items at once, by mouse and by finger: chosen, transformed with a preview, undone even after
// a reload; and what a mission was before.

import {
  draw,
  items,
  map_middle,
  map_pixels,
  open_page,
  press,
  save,
  tab,
  type Color,
} from './page';
import { expect, test } from './station';

const SQUARE = [
  [-100, -100],
  [100, -100],
  [100, 20],
  [-100, 20],
] as const;
/** The dashed line of what was before, and of another state. */
const BEFORE: Color = [91, 86, 70];
const THEIRS: Color = [184, 80, 10];

test('points in a box are turned, undone after a reload, and an old revision comes back', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  await tab(page, 'Plan');
  await draw(page, SQUARE);
  await save(page);
  const places = (): Promise<string[]> => items(page).allInnerTexts();
  const drawn = await places();
  const [x, y] = await map_middle(page);

  // A box around the upper two; with Shift one more is taken by its list entry.
  await press(page, 'Select several');
  await page.mouse.move(x - 140, y - 140);
  await page.mouse.down();
  await page.mouse.move(x + 140, y - 60, { steps: 4 });
  await page.mouse.up();
  await expect(page.getByLabel('Selection')).toContainText('Items 1 to 2');
  await items(page).nth(2).getByRole('button').click();
  await expect(page.getByLabel('Selection')).toContainText('Items 1 to 3');

  await press(page, 'Rotate');
  await page.getByRole('textbox', { name: 'Clockwise, °' }).fill('30');
  await page.getByRole('textbox', { name: 'Clockwise, °' }).press('Enter');
  await expect.poll(async () => (await map_pixels(page, [BEFORE])).length).toBeGreaterThan(50);
  expect(await places()).toEqual(drawn);
  // Not by what no field shows.
  await page.getByRole('textbox', { name: 'Clockwise, °' }).fill('x9');
  await press(page, 'Apply');
  await expect(page.getByText('A field is wrong')).toBeVisible();
  expect(await places()).toEqual(drawn);
  await page.getByRole('textbox', { name: 'Clockwise, °' }).fill('30');
  await page.getByRole('textbox', { name: 'Clockwise, °' }).press('Enter');
  await press(page, 'Apply');
  const turned = await places();
  expect(turned[0]).not.toBe(drawn[0]);
  expect(turned[3]).toBe(drawn[3]);

  // One that is dragged takes the others along.
  await press(page, 'None');
  await press(page, 'All');
  await press(page, 'Densify');
  await press(page, 'Apply');
  const dense = await items(page).count();
  expect(dense).toBeGreaterThan(4);
  await press(page, 'Done selecting');

  page.once('dialog', (dialog) => void dialog.accept());
  await page.reload();
  await tab(page, 'Plan');
  await expect(items(page)).toHaveCount(dense);
  await press(page, 'Undo');
  expect(await places()).toEqual(turned);
  await press(page, 'Undo');
  expect(await places()).toEqual(drawn);
  await expect(page.getByLabel('Summary')).toContainText('saved, revision 1');
  await press(page, 'Redo');
  await save(page);

  await press(page, 'Revisions…');
  await page
    .getByLabel('Stored revisions')
    .getByRole('button', { name: /^1 · created/ })
    .click();
  await expect(page.getByLabel('What differs')).toContainText('3 items other');
  await expect.poll(async () => (await map_pixels(page, [THEIRS])).length).toBeGreaterThan(50);
  await press(page, 'Back to revision 1');
  await expect(page.getByLabel('Summary')).toContainText('saved, revision 3');
  expect(await places()).toEqual(drawn);
  await press(page, 'Undo');
  expect(await places()).toEqual(turned);
});

test('what is chosen stays chosen through undo, and nothing is stored that is not seen', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  await tab(page, 'Plan');
  await draw(page, SQUARE);
  const [x, y] = await map_middle(page);
  const places = (): Promise<string[]> => items(page).allInnerTexts();

  // A fifth one between the upper two; then the last two are chosen.
  await press(page, 'Add points');
  await page.mouse.move(x, y - 100);
  await page.mouse.down();
  await page.mouse.move(x, y - 140, { steps: 4 });
  await page.mouse.up();
  await expect(items(page)).toHaveCount(5);
  const five = await places();
  await press(page, 'Select several');
  for (const k of [3, 4]) await items(page).nth(k).getByRole('button').click();
  await expect(page.getByLabel('Selection')).toContainText('Items 4 to 5');
  await press(page, 'Rotate');
  await page.getByRole('textbox', { name: 'Clockwise, °' }).fill('30');
  await page.getByRole('textbox', { name: 'Clockwise, °' }).press('Enter');

  // Not while something else is seen than would be stored.
  const button = page.getByRole('button', { name: 'Save', exact: true });
  await expect(button).toHaveAttribute('title', 'Apply or cancel the change first.');
  await page.keyboard.press('Control+s');
  await expect(page.getByText('Apply or cancel the change first.')).toBeVisible();
  expect(await station.rest('GET', '/missions')).toMatchObject({ items: [] });

  // Back to four: the same two, which are number 3 and 4 by now.
  await press(page, 'Undo');
  await expect(items(page)).toHaveCount(4);
  await expect(page.getByLabel('Selection')).toContainText('Items 3 to 4');
  await press(page, 'Redo');
  await expect(page.getByLabel('Selection')).toContainText('Items 4 to 5');
  await press(page, 'Rotate');
  await page.getByRole('textbox', { name: 'Clockwise, °' }).fill('30');
  await page.getByRole('textbox', { name: 'Clockwise, °' }).press('Enter');
  await press(page, 'Apply');
  const turned = await places();
  expect(turned.map((text, k) => text === five[k])).toEqual([true, true, true, false, false]);
});

test('what was cut in two is one again by a step back, and two by a step forward', async ({
  page,
  station,
}) => {
  const names = async (): Promise<string[]> => {
    const { items: all } = await station.rest<{ items: { name: string }[] }>('GET', '/missions');
    return all.map(({ name }) => name).sort();
  };
  await open_page(page, station.url);
  await tab(page, 'Plan');
  await draw(page, SQUARE);
  await save(page);
  const [name = ''] = await names();
  await press(page, 'Select several');
  await items(page).nth(1).getByRole('button').click();
  await press(page, 'Split here');
  await expect(items(page)).toHaveCount(2);
  await expect.poll(names).toEqual([name, `${name} (2)`]);

  // when it is undone, then the second part is gone with it; and back when it is done again
  await press(page, 'Undo');
  await expect(items(page)).toHaveCount(4);
  await expect(page.getByText(`“${name} (2)” is deleted again`)).toBeVisible();
  expect(await names()).toEqual([name]);
  await press(page, 'Redo');
  await expect(items(page)).toHaveCount(2);
  await expect.poll(names).toEqual([name, `${name} (2)`]);

  // when somebody has changed the second part, then it stays
  interface Stored {
    readonly id: string;
    readonly name: string;
    readonly revision: number;
  }
  const { items: all } = await station.rest<{ items: Stored[] }>('GET', '/missions');
  const second = all.find((each) => each.name === `${name} (2)`);
  if (!second) throw new Error('no second part');
  const etag = { 'If-Match': `"rev-${second.revision}"` };
  await station.rest('PATCH', `/missions/${second.id}`, { name: 'Orchard' }, etag);
  await press(page, 'Undo');
  await expect(page.getByText(`“${name} (2)” stays`)).toBeVisible();
  expect(await names()).toEqual([name, 'Orchard'].sort());
});

test('the revisions of one mission are not those of the next', async ({ page, station }) => {
  const { lat, lon } = station.sim.now;
  const make = (name: string, north: number) =>
    station.rest<{ id: string }>('POST', '/missions', {
      name,
      items: [{ type: 'waypoint', lat: lat + north, lon }],
    });
  const field = await make('Field', 0.0001);
  await make('Orchard', 0.0002);
  await open_page(page, station.url);
  const open = async (name: RegExp): Promise<void> => {
    await tab(page, 'Missions');
    await page.getByRole('button', { name }).first().click();
    await expect(page.getByRole('button', { name: 'Select several' })).toBeVisible();
  };
  await open(/^Field/);
  await press(page, 'Revisions…');
  const list = page.getByLabel('Stored revisions');
  await list.getByRole('button', { name: /^1 · created/ }).click();
  await open(/^Orchard/);
  await expect(list).toBeHidden();
  await expect(page.getByRole('button', { name: /^Back to revision/ })).toBeHidden();
  await press(page, 'Revisions…');
  await expect(list.getByRole('button')).toHaveCount(1);
  await expect(list).toBeInViewport();
  expect(await station.rest('GET', `/missions/${field.id}`)).toMatchObject({ revision: 1 });
});

test.describe('with a finger, on a phone', () => {
  test.use({ viewport: { width: 390, height: 844 }, hasTouch: true, deviceScaleFactor: 2 });

  test('the way is taken anywhere, a glass shows what the finger hides, chosen points move together', async ({
    page,
    station,
  }) => {
    await open_page(page, station.url);
    await tab(page, 'Plan');
    const [x, y] = await map_middle(page);
    for (const right of [-120, 60]) await page.touchscreen.tap(x + right, y - 60);
    await expect(items(page)).toHaveCount(2);
    const session = await page.context().newCDPSession(page);
    const touch = (type: 'touchStart' | 'touchMove' | 'touchEnd', at?: readonly [number, number]) =>
      session.send('Input.dispatchTouchEvent', {
        type,
        touchPoints: at ? [{ x: at[0], y: at[1] }] : [],
      });
    const drag = async (from: readonly [number, number], down: number): Promise<void> => {
      await touch('touchStart', from);
      for (let k = 1; k <= 4; k += 1) await touch('touchMove', [from[0], from[1] + (k * down) / 4]);
    };

    // A third of the way along, far from its "+".
    await drag([x - 70, y - 60], 60);
    await expect(page.locator('.map-loupe')).toBeVisible();
    await touch('touchEnd');
    await expect(page.locator('.map-loupe')).toBeHidden();
    await expect(items(page)).toHaveCount(3);
    const before = await items(page).allInnerTexts();

    await press(page, 'Select several');
    await page.getByLabel('Selection').getByRole('button', { name: 'All', exact: true }).click();
    await drag([x - 120, y - 60], 40);
    await touch('touchEnd');
    const latitude = (text: string): number => Number(/(-?\d+\.\d+),/.exec(text)?.[1]);
    await expect.poll(async () => (await items(page).allInnerTexts())[0]).not.toBe(before[0]);
    const after = await items(page).allInnerTexts();
    const moved = after.map((text, k) => latitude(text) - latitude(before[k] ?? ''));
    expect(moved[0]).toBeLessThan(0);
    for (const by of moved) expect(by).toBeCloseTo(moved[0] ?? 0, 6);
  });
});

test('a mission cut in two is one again by a step back, also after a reload', async ({
  page,
  station,
}) => {
  interface Listed {
    readonly id: string;
    readonly name: string;
    readonly revision: number;
  }
  const stored = async (): Promise<readonly Listed[]> =>
    (await station.rest<{ items: readonly Listed[] }>('GET', '/missions')).items;
  const reload = async (): Promise<void> => {
    page.once('dialog', (dialog) => void dialog.accept());
    await page.reload();
    await tab(page, 'Plan');
  };
  await open_page(page, station.url);
  await tab(page, 'Plan');
  await draw(page, SQUARE);
  await save(page);
  await press(page, 'Select several');
  await items(page).nth(1).getByRole('button').click();
  await press(page, 'Split here');
  await expect(items(page)).toHaveCount(2);
  await expect.poll(async () => (await stored()).length).toBe(2);

  await reload();
  await expect(items(page)).toHaveCount(2);
  await press(page, 'Undo');
  await expect(items(page)).toHaveCount(4);
  await expect(page.getByLabel('Messages')).toContainText('is deleted again: the two are one');
  await expect.poll(async () => (await stored()).length).toBe(1);

  // Forward after one more reload it is cut again, and stored as before.
  await reload();
  await press(page, 'Redo');
  await expect(items(page)).toHaveCount(2);
  await expect.poll(async () => (await stored()).length).toBe(2);

  // What somebody changed since is not taken away; the page says so.
  await save(page);
  const whole = await page.getByRole('textbox', { name: 'Name' }).inputValue();
  const second = (await stored()).find(({ name }) => name !== whole);
  if (!second) throw new Error('no second part');
  await station.rest(
    'PATCH',
    `/missions/${second.id}`,
    { tags: ['theirs'] },
    { 'If-Match': `"rev-${second.revision}"` },
  );
  await reload();
  await press(page, 'Undo');
  await expect(items(page)).toHaveCount(4);
  await expect(page.getByLabel('Messages')).toContainText('stays: somebody has changed it since');
  expect(await stored()).toHaveLength(2);
});
