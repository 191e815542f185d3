// What the robot knows itself by: entered, seen on the map, changed and forgotten on the page.

import { map_pixels, open_page, press, tab, type Color } from './page';
import { expect, test } from './station';

/** The edge of one that was not seen yet. */
const UNSEEN: Color = [91, 86, 70];

interface Known {
  readonly items: readonly {
    readonly name: string;
    readonly tag: number | null;
    readonly lat: number;
    readonly heading_deg: number | null;
  }[];
}

for (const [device, width, height] of [
  ['phone', 390, 844],
  ['laptop', 1440, 900],
] as const) {
  test(`a tag is entered where the robot stands, changed and forgotten on a ${device}`, async ({
    page,
    station,
  }) => {
    await page.setViewportSize({ width, height });
    await open_page(page, station.url);
    await tab(page, 'Log');
    await press(page, 'Known places');
    const card = page.getByRole('region', { name: 'Known places' });
    await expect(card).toContainText('None is known.');
    await card.getByRole('button', { name: 'Enter a place' }).click();
    // What may be left empty says what that means.
    await expect(card.getByLabel('It looks to')).toHaveAttribute('placeholder', 'not known');
    await expect(card.getByLabel('Known to')).toHaveAttribute('placeholder', '0.05');
    // The kind is readable in full.
    const kind = await card.getByLabel('What').boundingBox();
    expect(kind?.width).toBeGreaterThan(200);
    await card.getByLabel('Name').fill('shed_door');
    await card.getByLabel('Its number').fill('12');
    await card.getByLabel('Its number').press('Enter');
    // A form that lacks something sends nothing.
    await expect(card.getByRole('listitem')).toHaveCount(0);
    await card.getByLabel('It looks to').fill('200');
    await card.getByLabel('It looks to').press('Tab');
    await card.getByRole('button', { name: 'Where the robot stands' }).click();
    await card.getByRole('button', { name: 'Enter it' }).click();
    const entry = card.getByRole('listitem').filter({ hasText: 'shed_door' });
    await expect(entry).toContainText('Tag 12');
    await expect(entry).toContainText('Not seen yet');
    const known = async (): Promise<Known['items']> =>
      (await station.rest<Known>('GET', '/known-places')).items;
    const [first] = await known();
    expect(first).toMatchObject({ name: 'shed_door', tag: 12, heading_deg: 200 });
    expect(Math.abs((first?.lat ?? 0) - station.sim.now.lat)).toBeLessThan(2e-5);
    await expect.poll(async () => (await map_pixels(page, [UNSEEN], 6)).length).toBeGreaterThan(20);
    await entry.getByRole('button', { name: 'Change' }).click();
    await card.getByLabel('What').selectOption('pole');
    await card.getByRole('button', { name: 'Enter it' }).click();
    await expect(entry).toContainText('Pole or cone');
    expect((await known())[0]).toMatchObject({ tag: null, heading_deg: null });
    await entry.getByRole('button', { name: 'Forget it' }).click();
    await page.getByRole('dialog').getByRole('button', { name: 'Forget it' }).click();
    await expect(card).toContainText('None is known.');
    expect(await known()).toEqual([]);
  });
}
