// A mission planned in a map of the list while the robot is in none: at home, before the first drive there.

import type { Page } from '@playwright/test';

import {
  draw,
  items,
  map_middle,
  map_pixels,
  open_page,
  press,
  press_it,
  save,
  seen_frame,
  tab,
  type Color,
} from './page';
import { expect, test } from './station';

/** What stands there, in daylight. */
const WALL: Color = [38, 36, 44];
/** Of a route graph. */
const LINK: Color = [95, 61, 196];
const CELL_M = 0.1;
const [COLUMNS, ROWS] = [200, 160];

/** A room of 20 m x 16 m, its origin in the middle. */
const files = () => {
  const picture = Buffer.alloc(COLUMNS * ROWS, 254);
  for (let row = 0; row < ROWS; row += 1) {
    for (let column = 0; column < COLUMNS; column += 1) {
      const edge = Math.min(row, column, ROWS - 1 - row, COLUMNS - 1 - column);
      if (edge < 4) picture[row * COLUMNS + column] = 0;
    }
  }
  const yaml = [
    'image: shed.pgm',
    `resolution: ${CELL_M}`,
    'origin: [-10.0, -8.0, 0.0]',
    'negate: 0',
    'occupied_thresh: 0.65',
    'free_thresh: 0.196',
  ].join('\n');
  const head = Buffer.from(`P5\n${COLUMNS} ${ROWS}\n255\n`);
  return [
    { name: 'shed.yaml', mimeType: 'application/yaml', buffer: Buffer.from(`${yaml}\n`) },
    {
      name: 'shed.pgm',
      mimeType: 'application/octet-stream',
      buffer: Buffer.concat([head, picture]),
    },
  ];
};

const open_with_the_shed = async (page: Page, url: string): Promise<void> => {
  await open_page(page, url);
  await tab(page, 'Missions');
  await press(page, 'Maps');
  await page.getByLabel('Map files').setInputFiles(files());
  await expect(page.getByText('The map “shed” is stored.')).toBeVisible();
};

test('points are tapped in a map of the list, dragged, and saved, with the robot in no map', async ({
  page,
  station,
}) => {
  await open_with_the_shed(page, station.url);

  // when the mission counts from it, it is seen though it is not in use and lies nowhere
  await tab(page, 'Plan');
  await page.getByLabel('Counts from the map').selectOption('shed');
  await expect.poll(async () => (await map_pixels(page, [WALL])).length).toBeGreaterThan(500);
  await seen_frame(page);
  await draw(page, [
    [-60, -40],
    [60, 40],
  ]);
  await expect(items(page)).toHaveCount(2);
  await expect(items(page).first()).toContainText('In the map');
  await save(page);
  const [{ id = '' } = {}] = (await station.rest<{ items: { id: string }[] }>('GET', '/missions'))
    .items;
  interface Stored {
    readonly frame: { readonly map: string };
    readonly items: readonly {
      readonly type: string;
      readonly x_m: number;
      readonly y_m: number;
    }[];
  }
  const drawn = await station.rest<Stored>('GET', `/missions/${id}`);
  expect(drawn.frame).toEqual({ map: 'shed' });
  expect(drawn.items.map(({ type }) => type)).toEqual(['map_point', 'map_point']);
  // Up on the screen is north, and a map that lies nowhere is drawn with x to the east.
  const [a, b] = drawn.items;
  expect((b?.x_m ?? 0) - (a?.x_m ?? 0)).toBeGreaterThan(1);
  expect((a?.y_m ?? 0) - (b?.y_m ?? 0)).toBeGreaterThan(1);
  for (const { x_m, y_m } of drawn.items) {
    expect(Math.abs(x_m)).toBeLessThan(10);
    expect(Math.abs(y_m)).toBeLessThan(8);
  }

  // A hand moves one of them as any waypoint.
  const [x, y] = await map_middle(page);
  await page.mouse.move(x + 60, y + 40);
  await page.mouse.down();
  await page.mouse.move(x + 60, y - 40, { steps: 5 });
  await page.mouse.up();
  await save(page);
  const moved = await station.rest<Stored>('GET', `/missions/${id}`);
  expect(moved.items[1]?.x_m).toBeCloseTo(b?.x_m ?? 0, 1);
  expect(moved.items[1]?.y_m ?? 0).toBeCloseTo(a?.y_m ?? 0, 1);
});

test('a map that is laid and not in use is shown from the list', async ({ page, station }) => {
  await open_with_the_shed(page, station.url);
  const [{ id = 0 } = {}] = (await station.rest<{ items: { id: number }[] }>('GET', '/maps')).items;
  const { lat, lon } = station.sim.now;
  const anchor = { lat, lon, heading_deg: 90, accuracy_m: 0.3, heading_accuracy_deg: 1 };
  await station.rest('PATCH', `/maps/${id}`, { anchor });
  await page.getByRole('list', { name: 'Maps' }).getByRole('button', { name: /^shed/ }).click();
  const show = page.getByRole('button', { name: 'Show', exact: true });
  await expect(show).not.toHaveAttribute('aria-disabled', 'true', { timeout: 20_000 });
  expect(await map_pixels(page, [WALL])).toHaveLength(0);
  await show.click();
  await expect.poll(async () => (await map_pixels(page, [WALL])).length).toBeGreaterThan(500);
  // Whoever leaves the list drives by what is in use.
  await tab(page, 'Drive');
  await expect.poll(async () => (await map_pixels(page, [WALL])).length).toBe(0);
});

test('a route graph lies on the map that is planned in, and a way through it is added', async ({
  page,
  station,
}) => {
  await open_with_the_shed(page, station.url);
  await tab(page, 'Plan');
  await press(page, 'Route graph');
  const card = page.getByRole('region', { name: 'Route graph' });
  const add = card.getByRole('button', { name: 'Add a graph file…' });
  await expect(add).toHaveAttribute('aria-disabled', 'true');
  await page.getByLabel('Counts from the map').selectOption('shed');
  await expect.poll(async () => (await map_pixels(page, [WALL])).length).toBeGreaterThan(500);
  const pixels = async (): Promise<number> => (await map_pixels(page, [LINK])).length;
  const before = await pixels(); // home may be in sight, of the same colour

  // when a file is added to the map that is planned in
  const text = [
    'Node id=1 pose=-6 -5 0 links=2 ~',
    'Node id=2 pose=6 -5 0 links=1 3 ~',
    'Node id=3 pose=6 5 1.5708 links=2 ~',
    'Home id=1 ~',
  ].join('\n');
  await card
    .getByLabel('Graph file')
    .setInputFiles({ name: 'ways.txt', mimeType: 'text/plain', buffer: Buffer.from(text) });
  await expect(card.getByText('Nodes: 3, links: 4')).toBeVisible();
  await expect.poll(pixels).toBeGreaterThan(before + 100);

  // then ways through it become points of the map
  const way = card.getByRole('button', { name: 'Add the way' });
  await card.getByLabel('To node').fill('3');
  await card.getByLabel('To node').blur();
  await press_it(way);
  await expect(card.getByRole('alert')).toContainText('no map is in use');
  await card.getByLabel('From node').fill('1');
  await card.getByLabel('From node').blur();
  await press_it(way);
  await expect(items(page)).toHaveCount(3);
  await expect(items(page).last()).toContainText(/x 6(\.00)? m, y 5(\.00)? m/);
});
