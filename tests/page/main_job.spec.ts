// The main job, end to end: draw a route in the browser, and the robot drives it.

import { draw, drive_it, items, metres_between, open_page, save, tab, type Point } from './page';
import { expect, test } from './station';

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

test('a route drawn on the map is driven: every waypoint within 0.5 m, then it stops', async ({
  page,
  station,
}) => {
  test.setTimeout(240_000);
  await open_page(page, station.url);
  await tab(page, 'Plan');
  await draw(page, SQUARE);
  await expect(items(page)).toHaveCount(4);
  await page.getByLabel('Mission name').fill('Square');
  await page.getByLabel('Mission name').press('Enter');
  await save(page);

  const list = await station.rest<{ items: { id: string; name: string }[] }>('GET', '/missions');
  expect(list.items).toHaveLength(1);
  const [stored] = list.items;
  expect(stored?.name).toBe('Square');
  const mission = await station.rest<Mission>('GET', `/missions/${stored?.id ?? ''}`);
  expect(mission.items.map(({ type }) => type)).toEqual(Array(4).fill('waypoint'));

  const before = station.sim.track.length;
  await drive_it(page);
  await expect(page.getByRole('group', { name: 'Mode' }).first()).toContainText('AUTO');
  await expect(page.getByLabel('Mission state')).toHaveText('Finished', {
    timeout: 200_000,
  });

  const driven = station.sim.track.slice(before);
  let from = 0;
  mission.items.forEach((waypoint, k) => {
    let best = Number.POSITIVE_INFINITY;
    let at = from;
    for (let n = from; n < driven.length; n += 1) {
      const distance = metres_between(driven[n] as Point, waypoint);
      if (distance < best) [best, at] = [distance, n];
    }
    expect(best, `true distance to waypoint ${k + 1}, in order`).toBeLessThan(0.5);
    from = at;
  });

  await expect.poll(() => Math.abs(station.sim.now.speed_mps)).toBeLessThan(0.01);
  const resting = station.sim.now;
  await page.waitForTimeout(2000);
  expect(metres_between(resting, station.sim.now)).toBeLessThan(0.02);
  const end = mission.items.at(-1) as Point;
  expect(metres_between(end, station.sim.now)).toBeLessThan(0.5);
});
