// Files from the field: missions of other ground stations, and a recorded receiver.

import { readFileSync } from 'node:fs';
import { basename } from 'node:path';

import { expect as expect_base, type Page } from '@playwright/test';

import { items, metres_between, tab, type Point } from './page';
import { expect, real_file, test } from './station';

interface Mission {
  readonly items: readonly (Point & { readonly type: string })[];
}

/** Positions of a QGroundControl plan, read by this test itself. */
const plan_positions = (text: string): Point[] => {
  const plan = JSON.parse(text) as {
    mission: { items: { command?: number; params?: (number | null)[] }[] };
  };
  return plan.mission.items
    .filter(({ command }) => command === 16)
    .map(({ params = [] }) => ({ lat: params[4] ?? 0, lon: params[5] ?? 0 }));
};

/** Positions of a QGC WPL 110 file, home (row 0) left out. */
const waypoint_positions = (text: string): Point[] =>
  text
    .split('\n')
    .slice(2)
    .map((row) => row.trim().split(/\s+/))
    .filter((columns) => columns[3] === '16')
    .map((columns) => ({ lat: Number(columns[8]), lon: Number(columns[9]) }));

const FILES = [
  { name: 'mission-sitl.plan', format: 'plan', read: plan_positions },
  {
    name: 'mission-rover-basic.waypoints',
    format: 'waypoints',
    read: waypoint_positions,
  },
] as const;

const same_places = (found: readonly Point[], wanted: readonly Point[]): void => {
  expect_base(found).toHaveLength(wanted.length);
  wanted.forEach((point, k) => {
    expect_base(metres_between(found[k] as Point, point)).toBeLessThan(0.001);
  });
};

const export_text = async (page: Page, format: string): Promise<string> => {
  await page.getByRole('button', { name: /^More about/ }).click();
  const download = page.waitForEvent('download');
  await page.getByRole('link', { name: `.${format}`, exact: true }).click();
  return readFileSync(await (await download).path(), 'utf8');
};

for (const { name, format, read } of FILES) {
  test(`${name} imports, shows on the map and exports with the same positions`, async ({
    page,
    station,
  }) => {
    const file = real_file(name);
    test.skip(file === null, `${name} is not on this machine (ROVERD_REAL_DATA)`);
    if (file === null) return;
    const wanted = read(readFileSync(file, 'utf8'));
    expect(wanted.length).toBeGreaterThan(2);

    await page.goto(station.url);
    await tab(page, 'Missions');
    await page.getByLabel('Mission file').setInputFiles(file);
    await expect(page.getByRole('dialog')).toContainText(`“${basename(file)}” became the mission`);
    await page.getByRole('button', { name: 'Continue' }).click();

    const list = await station.rest<{ items: { id: string }[] }>('GET', '/missions');
    const id = list.items[0]?.id ?? '';
    const mission = await station.rest<Mission>('GET', `/missions/${id}`);
    same_places(
      mission.items.filter(({ type }) => type === 'waypoint'),
      wanted,
    );

    same_places(read(await export_text(page, format)), wanted);

    await tab(page, 'Plan');
    await expect(items(page)).toHaveCount(mission.items.length);
    await expect(page.locator('.scale-bar')).toHaveText(/\d+ (cm|m|km)/);
  });
}

test('a broken file is refused with the reason, and nothing is stored', async ({
  page,
  station,
}) => {
  await page.goto(station.url);
  await tab(page, 'Missions');
  await page.getByLabel('Mission file').setInputFiles({
    name: 'broken.plan',
    mimeType: 'application/json',
    buffer: Buffer.from('{"fileType": "Plan", "mission": {"items": ['),
  });
  await expect(page.getByLabel('Messages')).toContainText('“broken.plan” was not imported');
  await expect(page.getByText('No missions stored yet.')).toBeVisible();
});

type Color = readonly [red: number, green: number, blue: number];
const DRIVEN: Color = [168, 50, 122];
const FIXES: Color = [138, 109, 0];

/** Pixels of a colour on the map's canvas. */
const pixels = (page: Page, color: Color): Promise<number> =>
  page.evaluate(([red, green, blue]) => {
    const canvas = document.querySelector<HTMLCanvasElement>('#map canvas');
    const context = canvas?.getContext('2d');
    if (!canvas || !context) return 0;
    const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
    let count = 0;
    for (let k = 0; k < data.length; k += 4) {
      if (data[k] === red && data[k + 1] === green && data[k + 2] === blue) count += 1;
    }
    return count;
  }, color);

test('a recorded RTK receiver is replayed and its track is drawn', async ({ page, replay }) => {
  test.setTimeout(120_000);
  const file = real_file('gnss-nmea-rtk.log');
  test.skip(file === null, 'gnss-nmea-rtk.log is not on this machine (ROVERD_REAL_DATA)');
  if (file === null) return;
  await page.goto(await replay(file));
  await expect(page.getByRole('group', { name: 'Position' })).toContainText('sat', {
    timeout: 30_000,
  });
  for (let k = 0; k < 4; k += 1) await page.getByRole('button', { name: 'Zoom in' }).click();
  // Ten dots of what the receiver said, and a line of where the robot believes it was.
  await expect.poll(() => pixels(page, FIXES), { timeout: 60_000 }).toBeGreaterThan(250);
  await expect.poll(() => pixels(page, DRIVEN), { timeout: 60_000 }).toBeGreaterThan(250);
});
