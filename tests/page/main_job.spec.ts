// The main job, end to end: draw a route in the browser, and the robot drives it.

import type { Page } from '@playwright/test';

import {
  draw,
  drive_it,
  items,
  metres_between,
  open_page,
  pixels_per_m,
  save,
  tab,
  type Point,
} from './page';
import { expect, test, type Station } from './station';

type Pixel = readonly [right: number, down: number];

interface Mission {
  readonly items: readonly (Point & { readonly type: string })[];
}

//   1 ---- 2      about 8 m to each side of the robot, which starts in the middle
//          |
//   4 ---- 3
const SQUARE = [
  [-60, -70],
  [70, -80],
  [85, 40],
  [-50, 60],
] as const;

/** Nearest to each of the places, in order: one counts from where the one before it was nearest. */
const nearest_in_order_m = (driven: readonly Point[], places: readonly Point[]): number[] => {
  let from = 0;
  return places.map((place) => {
    let best = Number.POSITIVE_INFINITY;
    let at = from;
    for (let n = from; n < driven.length; n += 1) {
      const distance = metres_between(driven[n] as Point, place);
      if (distance < best) [best, at] = [distance, n];
    }
    from = at;
    return best;
  });
};

/** The one mission that is stored, as the page wrote it. */
const stored_mission = async (station: Station, name: string): Promise<Mission> => {
  const list = await station.rest<{ items: { id: string; name: string }[] }>('GET', '/missions');
  expect(list.items.map((each) => each.name)).toEqual([name]);
  return station.rest<Mission>('GET', `/missions/${list.items[0]?.id ?? ''}`);
};

const draw_and_save = async (page: Page, name: string, places: readonly Pixel[]): Promise<void> => {
  await tab(page, 'Plan');
  await draw(page, places);
  await expect(items(page)).toHaveCount(places.length);
  await page.getByLabel('Mission name').fill(name);
  await page.getByLabel('Mission name').press('Enter');
  await save(page);
};

const finished = (page: Page): Promise<void> =>
  expect(page.getByLabel('Mission state')).toHaveText('Finished', { timeout: 200_000 });

test('a route drawn on the map is driven: every waypoint within 0.5 m, then it stops', async ({
  page,
  station,
}) => {
  test.setTimeout(240_000);
  await open_page(page, station.url);
  await draw_and_save(page, 'Square', SQUARE);
  const mission = await stored_mission(station, 'Square');
  expect(mission.items.map(({ type }) => type)).toEqual(Array(4).fill('waypoint'));

  const before = station.sim.track.length;
  await drive_it(page);
  await expect(page.getByRole('group', { name: 'Mode' }).first()).toContainText('AUTO');
  await finished(page);
  nearest_in_order_m(station.sim.track.slice(before), mission.items).forEach((distance, k) => {
    expect(distance, `true distance to waypoint ${k + 1}, in order`).toBeLessThan(0.5);
  });

  await expect.poll(() => Math.abs(station.sim.now.speed_mps)).toBeLessThan(0.01);
  const resting = station.sim.now;
  await page.waitForTimeout(2000);
  expect(metres_between(resting, station.sim.now)).toBeLessThan(0.02);
  const end = mission.items.at(-1) as Point;
  expect(metres_between(end, station.sim.now)).toBeLessThan(0.5);
});

// Metres ahead and left of where the vehicle stands: cars need room for a bend.
const ROUTES: Record<string, readonly Pixel[]> = {
  uku: [[4, 0], [9, 0], [13, 4]], // prettier-ignore
  imiev: [[4, 0], [12, 0], [18, 4]], // prettier-ignore
  probot: [[2, 0], [2, 2]], // prettier-ignore
  donkey: [[2, 0], [2, 2]], // prettier-ignore
  husky: [[3, 0], [3, 3]], // prettier-ignore
};

for (const [name, route] of Object.entries(ROUTES)) {
  test(`the ${name} drives what is drawn for it`, async ({ page, vehicle }) => {
    test.setTimeout(240_000);
    const station = await vehicle(name);
    await open_page(page, station.url);
    const scale = await pixels_per_m(page);
    const heading = (station.sim.now.heading_deg * Math.PI) / 180;
    const places = route.map(([ahead_m, left_m]): Pixel => {
      const east_m = ahead_m * Math.sin(heading) - left_m * Math.cos(heading);
      const north_m = ahead_m * Math.cos(heading) + left_m * Math.sin(heading);
      return [east_m * scale, -north_m * scale];
    });
    await draw_and_save(page, name, places);
    const mission = await stored_mission(station, name);

    const before = station.sim.track.length;
    await drive_it(page);
    await finished(page);
    nearest_in_order_m(station.sim.track.slice(before), mission.items).forEach((distance, k) => {
      expect(distance, `true distance to waypoint ${k + 1}, in order`).toBeLessThan(0.5);
    });
    await expect.poll(() => Math.abs(station.sim.now.speed_mps)).toBeLessThan(0.01);
    expect(metres_between(mission.items.at(-1) as Point, station.sim.now)).toBeLessThan(0.5);
  });
}
