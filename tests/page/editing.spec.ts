// Editing on the map: what is drawn, moved, inserted and deleted; undo; conflicts; drafts.

import { draw, items, map_middle, open_page, press, save, tab } from './page';
import { expect, test, type Station } from './station';

interface Mission {
  readonly id: string;
  readonly revision: number;
  readonly name: string;
  readonly items: readonly {
    readonly type: string;
    readonly lat: number;
    readonly lon: number;
  }[];
}

const stored_missions = async (station: Station): Promise<readonly Mission[]> =>
  (await station.rest<{ items: readonly Mission[] }>('GET', '/missions')).items;

const LINE = [
  [-200, -100],
  [0, -100],
  [200, -100],
] as const;

test('points are drawn, moved, inserted, edited and deleted, and every step is undone', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  await tab(page, 'Plan');
  await draw(page, LINE);
  await expect(items(page)).toHaveCount(3);
  const places = (): Promise<string[]> => items(page).allInnerTexts();
  const drawn = await places();
  const [x, y] = await map_middle(page);
  // A field's name stands nearer to it than to the field above.
  const at_end = await page.getByLabel('At the end the robot').boundingBox();
  const corridor = await page.getByLabel('Corridor to each side, m').boundingBox();
  if (!at_end || !corridor) throw new Error('no fields of the mission');
  expect(corridor.y - (at_end.y + at_end.height)).toBeGreaterThan(24);

  await page.mouse.move(x, y - 100);
  await page.mouse.down();
  await page.mouse.move(x, y + 60, { steps: 6 });
  await page.mouse.up();
  await expect.poll(places).not.toEqual(drawn);
  const moved = await places();
  expect([moved[0], moved[2]]).toEqual([drawn[0], drawn[2]]);

  // The "+" between the first two points.
  await page.mouse.click(x - 100, y - 20);
  await expect(items(page)).toHaveCount(4);

  await page.getByLabel('Hold, s').fill('2,5');
  await page.getByLabel('Hold, s').press('Enter');
  await page.getByLabel('Latitude').fill('95');
  await page.getByLabel('Latitude').press('Enter');
  await expect(page.getByText('Latitude must be from -90 to 90.')).toBeVisible();

  await press(page, 'Delete item');
  await expect(items(page)).toHaveCount(3);

  await page.keyboard.press('Control+z');
  await expect(items(page)).toHaveCount(4);
  for (const _ of ['hold', 'insert']) await press(page, 'Undo');
  await expect(items(page)).toHaveCount(3);
  expect(await places()).toEqual(moved);
  await press(page, 'Undo');
  expect(await places()).toEqual(drawn);
  await page.keyboard.press('Control+y');
  expect(await places()).toEqual(moved);
});

test('a draft survives a reload of the page, saved missions come from the server', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  await tab(page, 'Plan');
  await draw(page, LINE);
  await expect(items(page)).toHaveCount(3);
  page.once('dialog', (dialog) => void dialog.accept());
  await page.reload();
  await tab(page, 'Plan');
  await expect(items(page)).toHaveCount(3);
  await expect(page.getByText('Restored your unsaved draft')).toBeVisible();

  await save(page);
  const [mission] = await stored_missions(station);
  expect(mission?.revision).toBe(1);
  await page.reload();
  await tab(page, 'Plan');
  await expect(page.getByLabel('Summary')).toContainText('saved, revision 1');
});

test('steps are undone in a mission that was left and opened again, and after a reload', async ({
  page,
  station,
}) => {
  const name = page.getByLabel('Mission name');
  const open = async (wanted: string) => {
    await tab(page, 'Missions');
    await page.getByRole('list', { name: 'Stored missions' }).getByText(wanted).click();
  };
  await station.rest('POST', '/missions', { name: 'Other', items: [] });
  await open_page(page, station.url);
  await tab(page, 'Plan');
  await name.fill('Mine');
  await name.press('Enter');
  await draw(page, LINE);
  await press(page, 'New');
  await press(page, 'Discard');
  await expect(items(page)).toHaveCount(0);
  await press(page, 'Undo'); // it was never saved, and is back
  await expect(items(page)).toHaveCount(3);
  await save(page);
  await draw(page, [[0, -60]]); // not saved
  await expect(items(page)).toHaveCount(4);

  await open('Other');
  await press(page, 'Discard');
  await expect(name).toHaveValue('Other');
  await page.reload();
  await open('Mine');

  // It is as it is stored; what was not saved is one step back, and all before it.
  await expect(items(page)).toHaveCount(3);
  await expect(page.getByLabel('Summary')).toContainText('saved, revision 1');
  await press(page, 'Undo');
  await expect(items(page)).toHaveCount(4);
  await press(page, 'Undo');
  await expect(items(page)).toHaveCount(3);
  await press(page, 'Undo');
  await expect(items(page)).toHaveCount(2);
  await press(page, 'Redo');
  await expect(items(page)).toHaveCount(3);
});

test('when somebody else saved first, nothing is lost and the person chooses', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  await tab(page, 'Plan');
  await draw(page, LINE);
  await save(page);
  const [mine] = await stored_missions(station);
  const id = mine?.id ?? '';
  const full = await station.rest<Mission>('GET', `/missions/${id}`);
  await draw(page, [[0, 100]]);
  await expect(items(page)).toHaveCount(4);
  const theirs = { name: 'Theirs', items: full.items.slice(0, 2) };
  await station.rest('PUT', `/missions/${id}`, theirs, {
    'If-Match': '"rev-1"',
  });

  await press(page, 'Save');
  const dialog = page.getByRole('dialog');
  await expect(dialog).toContainText('revision 2 of “Theirs”');
  await dialog.getByRole('button', { name: 'Load theirs' }).click();
  await expect(items(page)).toHaveCount(2);
  await press(page, 'Undo');
  await expect(items(page)).toHaveCount(4);

  await save(page);
  const after = await station.rest<Mission>('GET', `/missions/${id}`);
  expect(after).toMatchObject({ revision: 3, name: full.name });
  expect(after.items).toHaveLength(4);

  // A copy is called so, on the screen as well.
  await draw(page, [[0, 120]]);
  const third = { name: 'Third', items: full.items.slice(0, 2) };
  await station.rest('PUT', `/missions/${id}`, third, { 'If-Match': '"rev-3"' });
  await press(page, 'Save');
  await dialog.getByRole('button', { name: 'Keep mine as a copy' }).click();
  const copy = `${full.name} (copy)`;
  await expect(page.getByText(`Saved “${copy}”`)).toBeVisible();
  await expect(page.getByLabel('Mission name')).toHaveValue(copy);
});

test('a mission of 10,000 items is shown and stays quick to edit', async ({ page, station }) => {
  test.setTimeout(90_000);
  const { lat, lon } = station.sim.now;
  const many = Array.from({ length: 10_000 }, (_, k) => ({
    type: 'waypoint',
    lat: lat + Math.floor(k / 100) * 2e-5,
    lon: lon + (Math.floor(k / 100) % 2 === 0 ? k % 100 : 99 - (k % 100)) * 4e-5,
  }));
  await station.rest('POST', '/missions', { name: 'Field', items: many });
  await open_page(page, station.url);
  await tab(page, 'Missions');
  await page.getByRole('button', { name: /^Field/ }).click();
  await expect(page.getByLabel('Summary')).toContainText('10000 items', {
    timeout: 15_000,
  });

  await press(page, 'Reverse');
  await expect(page.getByLabel('Summary')).toContainText('unsaved changes');

  /** From a press to the picture, milliseconds: the quickest of some, other programs run too. */
  const quickest_ms = (names: readonly string[]): Promise<number> =>
    page.evaluate(async (labels) => {
      const times: number[] = [];
      for (const label of labels) {
        const begin = performance.now();
        document.querySelector<HTMLButtonElement>(`[aria-label="${label}"]`)?.click();
        await new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
        times.push(performance.now() - begin);
      }
      return Math.min(...times);
    }, names);

  expect(await quickest_ms(['Undo', 'Redo', 'Undo', 'Redo', 'Undo'])).toBeLessThan(3000);
  await expect(page.getByLabel('Summary')).toContainText('saved, revision 1');
  const zooms = ['Zoom in', 'Zoom out', 'Zoom in', 'Zoom out', 'Zoom in', 'Zoom out'];
  expect(await quickest_ms(zooms)).toBeLessThan(3000);
});
