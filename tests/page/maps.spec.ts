// The map of a place: sent, taken into use, seen, and told where in it the robot stands.

import type { Page } from '@playwright/test';

import {
  draw,
  map_pixels,
  open_page,
  pixels_per_m,
  press,
  tab,
  type Color,
  type Pixel,
} from './page';
import { expect, test, type Station } from './station';

/** What stands there, in daylight. */
const WALL: Color = [38, 36, 44];
/** The world's origin, where the robot begins: x = y = 0 of the map. */
const START = { lat: 58.37802, lon: 26.7289 };
const CELL_M = 0.05;
const HALF_M = 0.1;
const [LEFT_M, LOW_M, COLUMNS, ROWS] = [-5, -6, 380, 320];

//  8  ┌────────────┬─────┬────┐
//     │            │     │    │    15 m × 12 m, a partition with a door,
//  5  │──          │          │    no two corners alike
//     │
//  0  │   R        │          │
// -4  └────────────┴──────────┘
//    -3            6         12
type Wall = readonly [number, number, number, number];
const WALLS: readonly Wall[] = [
  [-3, -4, 12, -4],
  [12, -4, 12, 8],
  [12, 8, -3, 8],
  [-3, 8, -3, -4],
  [6, -4, 6, 0.6],
  [6, 3.4, 6, 8],
  [-3, 5, -1.2, 5],
  [9, 8, 9, 6.2],
];
const world = {
  name: 'hall',
  ground: { grass_m: 0 },
  things: WALLS.map(([ax, ay, bx, by]) => ({
    kind: 'wall',
    points: [
      [ax, ay],
      [bx, by],
    ],
    height_m: 2.5,
    thickness_m: 2 * HALF_M,
  })),
};
test.use({ world });

/** Both files, as a map server keeps them. */
const files = () => {
  const picture = Buffer.alloc(COLUMNS * ROWS, 254);
  const column = (x_m: number): number => Math.round((x_m - LEFT_M) / CELL_M);
  const row = (y_m: number): number => ROWS - Math.round((y_m - LOW_M) / CELL_M);
  for (const [ax, ay, bx, by] of WALLS) {
    const thick = (a: number, b: number): number => (a === b ? HALF_M : 0);
    const [x0, x1] = [Math.min(ax, bx) - thick(ax, bx), Math.max(ax, bx) + thick(ax, bx)];
    const [y0, y1] = [Math.min(ay, by) - thick(ay, by), Math.max(ay, by) + thick(ay, by)];
    for (let r = row(y1); r < row(y0); r += 1) {
      picture.fill(0, r * COLUMNS + column(x0), r * COLUMNS + column(x1));
    }
  }
  const yaml = [
    'image: hall.pgm',
    `resolution: ${CELL_M}`,
    `origin: [${LEFT_M}, ${LOW_M}, 0.0]`,
    'negate: 0',
    'occupied_thresh: 0.65',
    'free_thresh: 0.196',
  ].join('\n');
  const head = Buffer.from(`P5\n${COLUMNS} ${ROWS}\n255\n`);
  return [
    { name: 'hall.yaml', mimeType: 'application/yaml', buffer: Buffer.from(`${yaml}\n`) },
    {
      name: 'hall.pgm',
      mimeType: 'application/octet-stream',
      buffer: Buffer.concat([head, picture]),
    },
  ];
};

interface Stored {
  readonly id: number;
  readonly name: string;
  readonly in_use: boolean;
  readonly forbidden?: readonly (readonly { readonly x_m: number; readonly y_m: number }[])[];
}
interface Place {
  readonly state: string;
  readonly map_id: number | null;
  readonly x_m: number | null;
  readonly y_m: number | null;
}

const place = async (station: Station): Promise<Place> =>
  (await station.rest<{ place: Place }>('GET', '/vehicle')).place;

const stored = async (station: Station): Promise<Stored> => {
  const { items } = await station.rest<{ items: Stored[] }>('GET', '/maps');
  return station.rest<Stored>('GET', `/maps/${items[0]?.id ?? 0}`);
};

const item = (page: Page) => page.getByRole('list', { name: 'Maps' }).getByRole('listitem');
const walls = (page: Page): Promise<Pixel[]> => map_pixels(page, [WALL]);

const open_maps = async (page: Page): Promise<void> => {
  await tab(page, 'Missions');
  await press(page, 'Maps');
};

/** Sends both files, and says where the map lies. */
const send_map = async (page: Page): Promise<void> => {
  await page.getByLabel('Map files').setInputFiles(files());
  await expect(page.getByText('The map “hall” is stored.')).toBeVisible();
  await item(page).getByRole('button', { name: /^hall/ }).click();
  await page.getByText('Where it lies').click();
  for (const [label, value] of [
    ['Latitude, °', START.lat],
    ['Longitude, °', START.lon],
    ['Its x axis looks to, °', 90],
    ['Known to, m', 0.3],
    ['Heading known to, °', 1],
  ] as const) {
    await page.getByLabel(label).fill(String(value));
    await page.getByLabel(label).press('Tab');
  }
  await press(page, 'It lies there');
  await expect(page.getByText('“hall” lies there from now on.')).toBeVisible();
};

/** Where a point of the map is on the page, by its upper right corner: what is seen tints others. */
const pixel_of = async (page: Page, x_m: number, y_m: number): Promise<Pixel> => {
  const found = await walls(page);
  const scale = await pixels_per_m(page);
  const right = Math.max(...found.map(([x]) => x));
  const top = Math.min(...found.map(([, y]) => y));
  return [right - (12 + HALF_M - x_m) * scale, top + (8 + HALF_M - y_m) * scale];
};

/** The same, once the view stands still: an alert that comes or goes moves it. */
const still_pixel = async (page: Page, x_m: number, y_m: number): Promise<Pixel> => {
  let [x, y] = [NaN, NaN];
  await expect(async () => {
    const before = [x, y];
    [x, y] = await pixel_of(page, x_m, y_m);
    expect([x, y]).toEqual(before);
  }).toPass({ intervals: [700] });
  return [x, y];
};

for (const [name, viewport] of [
  ['phone', { width: 390, height: 844 }],
  ['laptop', { width: 1440, height: 900 }],
] as const) {
  test(`on a ${name} a map is sent, used, seen, and the robot is shown its place in it`, async ({
    page,
    station,
  }) => {
    test.setTimeout(150_000);
    await page.setViewportSize(viewport);
    await open_page(page, station.url);
    station.sim.tell({ fault: { gnss_outage: true } });
    await open_maps(page);
    await send_map(page);
    await press(page, 'Use it');
    await expect(item(page)).toContainText('in use');
    await expect.poll(async () => (await walls(page)).length).toBeGreaterThan(200);

    // A layer as the others are.
    await tab(page, 'Drive');
    const layers = page.getByRole('group', { name: 'Layers on the map' });
    await layers.getByRole('button', { name: 'Map' }).click();
    await expect.poll(async () => (await walls(page)).length).toBeLessThan(20);
    await layers.getByRole('button', { name: 'Map' }).click();

    // "I am here": a press where it stands, and a drag to where it looks.
    const card = page.getByRole('region', { name: 'Place in the map' });
    await card.getByRole('button', { name: 'I am here…' }).click();
    const [x, y] = await still_pixel(page, 0, 0);
    const heading = (station.sim.now.heading_deg * Math.PI) / 180;
    await page.mouse.move(x, y);
    await page.mouse.down();
    for (const px of [20, 40, 60]) {
      await page.mouse.move(x + px * Math.sin(heading), y - px * Math.cos(heading));
    }
    await page.mouse.up();
    await expect(card).toContainText('It stands there and looks to');
    await card.getByRole('button', { name: 'It is there' }).click();
    await expect(card).toContainText('Knows its place in “hall”', { timeout: 40_000 });
    await expect(card.getByRole('status', { name: 'What came of it' })).toContainText(
      /It is there\. What it sees fits there, to ±\d+ cm\./,
    );
    const told = await place(station);
    expect(told).toMatchObject({ state: 'known', map_id: (await stored(station)).id });
    expect(Math.hypot(told.x_m ?? 9, told.y_m ?? 9)).toBeLessThan(0.3);
  });
}

test('a map is forbidden a corner by hand, taken back before it is saved, renamed and deleted', async ({
  page,
  station,
}) => {
  test.setTimeout(150_000);
  await page.setViewportSize({ width: 390, height: 844 });
  await open_page(page, station.url);
  await open_maps(page);
  await page.getByLabel('Map files').setInputFiles(files().slice(0, 1));
  await expect(
    page.getByText('The .pgm or .png is missing: pick both files together.'),
  ).toBeVisible();
  await send_map(page);
  await press(page, 'Change…');
  await expect.poll(async () => (await walls(page)).length).toBeGreaterThan(200);
  await press(page, '+ Forbid');
  await expect(page.getByRole('list', { name: 'What was drawn' })).toContainText('0 corners');
  // Messages may lie over the map: a finger reaches it all the same.
  await draw(page, [
    [-40, -30],
    [0, -30],
    [0, 30],
    [60, -60],
  ]);
  const drawn = page.getByRole('list', { name: 'What was drawn' });
  await expect(drawn).toContainText('4 corners');
  await press(page, 'Undo');
  await expect(drawn).toContainText('3 corners');
  expect((await stored(station)).forbidden).toEqual([]);
  await press(page, 'Save');
  await expect(page.getByText('Saved the map “hall”.')).toBeVisible();
  const [ring = []] = (await stored(station)).forbidden ?? [];
  expect(ring).toHaveLength(3);
  // The middle of what is in sight is the middle of the map.
  expect(ring[0]?.x_m).toBeLessThan(LEFT_M + (COLUMNS * CELL_M) / 2);
  expect(ring[0]?.y_m).toBeGreaterThan(LOW_M + (ROWS * CELL_M) / 2);

  // It is allowed again.
  await press(page, 'Allow forbidden area 1');
  await press(page, 'Save');
  await expect.poll(async () => (await stored(station)).forbidden).toEqual([]);
  await press(page, 'All maps');
  await page.getByLabel('Name of the map').fill('Shed');
  await page.getByLabel('Name of the map').press('Enter');
  await expect(item(page)).toContainText('Shed');
  await press(page, 'Delete');
  await page.getByRole('dialog').getByRole('button', { name: 'Delete' }).click();
  await expect(item(page)).toContainText('No maps');
});

test('a map whose cells are long under way is asked for once, and drawn', async ({
  page,
  station,
}) => {
  test.setTimeout(150_000);
  await open_page(page, station.url);
  let asked = 0;
  await page.route('**/api/v1/maps/*/cells*', async (route) => {
    asked += 1;
    await new Promise((resolve) => setTimeout(resolve, 15_000));
    await route.continue().catch(() => undefined);
  });
  await open_maps(page);
  await send_map(page);
  await press(page, 'Use it');
  await expect(item(page)).toContainText('in use');
  await expect
    .poll(async () => (await walls(page)).length, { timeout: 30_000 })
    .toBeGreaterThan(200);
  // Not with every look at the list of maps; where it was looked at before it was in use, once before.
  expect(asked).toBeGreaterThan(0);
  expect(asked).toBeLessThanOrEqual(2);

  // A file that misses the place where it may be dropped does not take the page away.
  const kept = await page.evaluate(() => {
    const dataTransfer = new DataTransfer();
    dataTransfer.items.add(new File(['x'], 'hall.yaml'));
    const drop = new DragEvent('drop', { dataTransfer, bubbles: true, cancelable: true });
    return !document.querySelector('header')?.dispatchEvent(drop);
  });
  expect(kept).toBe(true);
});

test('what another one forbade meanwhile is not allowed unseen', async ({ page, station }) => {
  test.setTimeout(120_000);
  await open_page(page, station.url);
  await open_maps(page);
  await send_map(page);
  const { id } = await stored(station);
  const forbid = (x_m: number): Promise<unknown> =>
    station.rest('PATCH', `/maps/${id}`, {
      edits: [
        {
          kind: 'forbid',
          polygon: [
            { x_m, y_m: 0 },
            { x_m: x_m + 1, y_m: 0 },
            { x_m, y_m: 1 },
          ],
        },
      ],
    });
  await forbid(0);
  await press(page, 'Change…');
  const forbidden = page.getByRole('list', { name: 'Forbidden' }).getByRole('listitem');
  await expect(forbidden).toHaveCount(1);
  await forbid(3);
  await press(page, 'Allow forbidden area 1');
  await press(page, 'Save');
  await expect(page.getByText('Not saved: the map was changed meanwhile')).toBeVisible();
  await expect(forbidden).toHaveCount(2);
  expect((await stored(station)).forbidden).toHaveLength(2);
  await press(page, 'Allow forbidden area 1');
  await press(page, 'Save');
  await expect.poll(async () => (await stored(station)).forbidden?.length).toBe(1);
});

test('what is forbidden in a map that nobody can place is told as not kept out of, as long as it is so', async ({
  page,
  station,
}) => {
  test.setTimeout(120_000);
  await open_page(page, station.url);
  await open_maps(page);
  await page.getByLabel('Map files').setInputFiles(files());
  await expect(page.getByText('The map “hall” is stored.')).toBeVisible();
  const { id } = await stored(station);
  const corners = [
    { x_m: 0, y_m: 0 },
    { x_m: 1, y_m: 0 },
    { x_m: 0, y_m: 1 },
  ];
  await station.rest('PATCH', `/maps/${id}`, { edits: [{ kind: 'forbid', polygon: corners }] });
  const unplaced = 'does not keep out of the 1 forbidden areas of the map in use';
  const told = page.getByRole('list', { name: 'Safety conditions' });
  await item(page).getByRole('button', { name: /^hall/ }).click();
  await expect(told).toBeHidden();
  await press(page, 'Use it');
  await expect(told).toContainText(unplaced);
  const { checks } = await station.rest<{ checks: { ok: boolean; detail: string }[] }>(
    'GET',
    '/vehicle/checks',
  );
  expect(checks.filter(({ detail }) => detail.includes(unplaced))).toMatchObject([{ ok: false }]);
  await press(page, 'Stop using it');
  await press(page, 'Without a map');
  await expect(page.getByText(unplaced)).toHaveCount(0);
});
