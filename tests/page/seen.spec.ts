// What the robot sees: on the map, in the panels, in the banner and to the ear.

import type { Page } from '@playwright/test';

import { arm, map_pixels, open_page, tab, type Color } from './page';
import { expect, test, type Station } from './station';

/** Solid cells and points of the scan, in daylight. */
const OCCUPIED: Color = [160, 60, 0];
const SCAN: Color = [11, 87, 208];
const METRE_LAT = 1 / 111_360;

/** A wall before the robot, which looks north, and a box beside it. */
const world = {
  name: 'wall',
  ground: { grass_m: 0.03 },
  things: [
    {
      kind: 'wall',
      points: [
        [-3, 5],
        [3, 5],
      ],
      height_m: 2,
    },
    { kind: 'box', at: [4, 1], length_m: 1, width_m: 1, height_m: 1 },
  ],
};
test.use({ world });

interface Sensors {
  readonly items: readonly { name: string; health: string }[];
}
const healths = async (station: Station): Promise<string> =>
  (await station.rest<Sensors>('GET', '/sensors')).items.map(({ health }) => health).join(' ');

/** Both sensors are heard, and the page shows the robot. */
const open_eyes = async (page: Page, station: Station): Promise<void> => {
  await open_page(page, station.url);
  await expect.poll(() => healths(station), { timeout: 30_000 }).toBe('good good');
};

/** How many pixels of the map look like that; cells are a little transparent. */
const pixels = async (page: Page, color: Color): Promise<number> =>
  (await map_pixels(page, [color], 17)).length;

const card_of = (page: Page) => page.getByRole('region', { name: 'What the robot sees' });

/** A mission straight to the north, through the wall. */
const drive_north = async (station: Station): Promise<void> => {
  const { lat, lon } = station.sim.now;
  const items = [1, 12].map((n) => ({ type: 'waypoint', lat: lat + n * METRE_LAT, lon }));
  const made = await station.rest<{ id: string; revision: number }>('POST', '/missions', {
    name: 'north',
    items,
  });
  await station.rest('POST', '/execution/load', { mission_id: made.id });
  await station.rest('POST', '/execution/start', {
    mission_id: made.id,
    revision: made.revision,
  });
};

/** A robot that casts and takes 300,000 rays a second, beside a browser without a graphics card. */
const ALONE = { tag: '@alone' };

test(
  'what stands there is shown, and a layer that was switched off stays off',
  ALONE,
  async ({ page, station }) => {
    await open_eyes(page, station);
    const card = card_of(page);
    await expect(card.getByRole('list', { name: 'Sensor lights' })).toContainText('front Sees');
    await expect(card.getByRole('list', { name: 'Things around' })).toContainText('Obstacle');
    await expect.poll(() => pixels(page, OCCUPIED)).toBeGreaterThan(20);
    const before = await pixels(page, SCAN);
    await card.getByRole('button', { name: 'Scan' }).click();
    await expect.poll(() => pixels(page, SCAN)).toBeGreaterThan(before + 100);
    await card.getByRole('button', { name: 'Seen' }).click();
    await expect.poll(() => pixels(page, OCCUPIED)).toBeLessThan(20);
    await open_page(page, station.url);
    await expect(card.getByRole('button', { name: 'Seen' })).toHaveAttribute(
      'aria-pressed',
      'false',
    );
    await expect(card.getByRole('button', { name: 'Scan' })).toHaveAttribute(
      'aria-pressed',
      'true',
    );
    await expect.poll(() => pixels(page, SCAN)).toBeGreaterThan(before + 100);
    expect(await pixels(page, OCCUPIED)).toBeLessThan(20);
  },
);

test(
  'what blocks is said with its sensor and since when, and heard',
  ALONE,
  async ({ page, station }) => {
    await page.addInitScript(() => {
      const notes: number[] = [];
      const node = { connect: (to: unknown) => to, start: () => undefined, stop: () => undefined };
      const gain = { setValueAtTime: () => undefined, linearRampToValueAtTime: () => undefined };
      Object.assign(window, {
        notes,
        AudioContext: class {
          currentTime = 0;
          destination = {};
          resume = () => Promise.resolve();
          createGain = () => ({ ...node, gain });
          createOscillator = () => {
            const frequency = {
              set value(hz: number) {
                notes.push(hz);
              },
            };
            return { ...node, frequency };
          };
        },
      });
    });
    await open_eyes(page, station);
    await arm(page);
    await drive_north(station);
    const banner = page.getByRole('list', { name: 'Safety conditions' });
    await expect(banner).toContainText(/Something stands in the way, .* seen by (front|top)\./, {
      timeout: 60_000,
    });
    await expect(banner).toContainText(/For [2-9] s\./);
    await expect(
      card_of(page).getByRole('list', { name: 'Things around' }).getByRole('listitem').first(),
    ).toContainText('Obstacle');
    const heard = () => page.evaluate(() => (window as unknown as { notes: number[] }).notes);
    // Beside the note of an item that was reached on the way.
    const REACHED_HZ = 1050;
    expect((await heard()).filter((hz) => hz !== REACHED_HZ).slice(0, 2)).toEqual([660, 440]);
    station.sim.tell({ world: false });
    await expect.poll(heard, { timeout: 30_000 }).toEqual(expect.arrayContaining([520, 780]));
  },
);

test(
  'a sensor that falls silent is seen in the list of sensors',
  ALONE,
  async ({ page, station }) => {
    await open_eyes(page, station);
    await tab(page, 'Log');
    const front = page.getByRole('listitem', { name: 'Sensor front' });
    await expect(front).toContainText('Hz');
    await expect(front).toContainText('missing');
    // What it sees now is a picture beside its words: of the box and the wall, the box is nearer.
    await expect(front).toContainText(/\d+ points, the nearest 3\.[4-7]\d m from the robot/);
    await expect(front.locator('svg .obstacle')).toHaveAttribute('d', /^M/);
    await front.screenshot({ path: '../tests/page/results/sensor-sight.png' });
    station.sim.tell({ fault: { sensor: 'front', sensor_silent: true } });
    await expect(front).toContainText('Silent');
    await expect(front).toContainText('It tells nothing just now.');
    await front.getByText('Details').click();
    await expect(front).toContainText('0.55 m ahead');
  },
);

test(
  'on a phone the guard is held off only while the button is held',
  ALONE,
  async ({ page, station }) => {
    test.setTimeout(150_000);
    const drives: { readonly override_guard?: boolean; readonly deadman: boolean }[] = [];
    page.on('websocket', (socket) =>
      socket.on('framesent', ({ payload }) => {
        const { drive } = JSON.parse(String(payload)) as { drive?: (typeof drives)[number] };
        if (drive) drives.push(drive);
      }),
    );
    await page.setViewportSize({ width: 390, height: 844 });
    await open_eyes(page, station);
    await expect(card_of(page)).toBeVisible();
    await arm(page);
    await station.rest('PUT', '/vehicle/mode', { mode: 'MANUAL' });
    const pad = page.getByRole('application', { name: /Drive pad/ });
    await pad.focus();
    const past = page.getByRole('button', { name: 'Drive past slowly (hold)' });
    await expect(past).toBeHidden();
    await page.keyboard.down('ArrowUp');
    await expect(past).toBeVisible({ timeout: 60_000 });
    expect(drives.some((drive) => drive.override_guard)).toBe(false);
    // In sight by itself, above the tabs: nobody scrolls while the other thumb drives.
    await expect(past).toBeInViewport({ ratio: 1 });
    await page.screenshot({ path: '../tests/page/results/override-phone.png' });
    const box = await past.boundingBox();
    await page.mouse.move((box?.x ?? 0) + 20, (box?.y ?? 0) + 20);
    await page.mouse.down();
    await expect.poll(() => drives.at(-1)?.override_guard).toBe(true);
    await page.mouse.up();
    await expect.poll(() => drives.at(-1)?.override_guard).toBeUndefined();
    expect(drives.at(-1)?.deadman).toBe(true);
    await page.keyboard.up('ArrowUp');
    await expect.poll(() => drives.at(-1)?.deadman).toBe(false);
  },
);
