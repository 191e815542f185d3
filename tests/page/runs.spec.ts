// What was driven: the list, a report, its track on the map, and two runs side by side.

import type { Page } from '@playwright/test';

import { arm, open_page, press, tab, type Point } from './page';
import { expect, test, type Station } from './station';

/** Begins a short bend. */
const begin = async (station: Station, name: string, speed_mps: number): Promise<void> => {
  const { home } = await station.rest<{ home: Point }>('GET', '/vehicle');
  const at = (north_m: number, east_m: number) => ({
    type: 'waypoint',
    lat: home.lat + north_m / 111_250,
    lon: home.lon + east_m / (111_320 * Math.cos((home.lat * Math.PI) / 180)),
  });
  const mission = await station.rest<{ id: string; revision: number }>('POST', '/missions', {
    name,
    settings: { speed_mps },
    items: [at(4, 1), at(8, 1), at(8, 5)],
  });
  await station.rest('POST', '/execution/load', { mission_id: mission.id });
  const { id, revision } = mission;
  await station.rest('POST', '/execution/start', { mission_id: id, revision, from: 'first' });
};
/** Drives it to its end. */
const drive = async (station: Station, name: string, speed_mps: number): Promise<void> => {
  await begin(station, name, speed_mps);
  const state = async () =>
    (await station.rest<{ mission: { state: string } }>('GET', '/vehicle')).mission.state;
  await expect.poll(state, { timeout: 90_000 }).toBe('finished');
};

/** Whether the plots have the colours of this run and of the other one. */
const plotted = (page: Page): Promise<boolean[]> =>
  page.evaluate(() => {
    const style = getComputedStyle(document.documentElement);
    const canvas = document.querySelector<HTMLCanvasElement>('.u-wrap canvas');
    const { data } = canvas?.getContext('2d')?.getImageData(0, 0, canvas.width, canvas.height) ?? {
      data: [],
    };
    return ['--run-a', '--run-b'].map((name) => {
      const color = Number.parseInt(style.getPropertyValue(name).trim().slice(1), 16);
      const wanted = [color >> 16, (color >> 8) & 255, color & 255];
      for (let k = 0; k < data.length; k += 4) {
        if (wanted.every((value, n) => data[k + n] === value)) return true;
      }
      return false;
    });
  });

test('a run has a report and a track, and is compared with another one', async ({
  page,
  station,
}) => {
  test.setTimeout(240_000);
  await page.setViewportSize({ width: 390, height: 844 });
  await open_page(page, station.url);
  await tab(page, 'Missions');
  await press(page, 'Runs');
  await expect(page.getByText('Nothing has been driven yet.')).toBeVisible();

  await tab(page, 'Drive');
  await arm(page);
  await drive(station, 'Slow bend', 0.4);
  await drive(station, 'Quick bend', 1.2);

  await tab(page, 'Missions');
  const list = page.getByRole('list', { name: 'Runs' });
  await expect(list.getByRole('button')).toHaveCount(2);
  await expect(list).toContainText('Finished');
  await list.getByRole('button', { name: /^Quick bend/ }).click();
  const report = page.getByRole('table', { name: 'Report' });
  await expect(report.getByRole('row', { name: /Off the path, rms/ })).toContainText(/cm|m/);
  await expect(report.getByRole('row', { name: /^Driven/ })).toContainText(/1\d\.\d m/);
  await page.getByText('Each corner').click();
  await expect(page.getByRole('table', { name: 'Corners' })).toContainText('90°');

  // The moment that is looked at stands on the map and in words, and events lead to theirs.
  const moment = page.getByRole('slider', { name: 'Moment of the run' });
  await moment.press('End');
  await expect(page.getByText(/^\d+ s · 1\d\.\d m · /)).toBeVisible();
  await page.getByText(/^What happened/).click();
  const events = page.getByRole('list', { name: 'Events of the run' });
  await events.getByRole('button').first().click();
  await expect(moment).toHaveAttribute('aria-valuetext', /^[01] s$/);
  await expect(page.getByRole('img', { name: /^Plots of Off the path.*Speed/ })).toBeVisible();
  await expect(page.locator('.u-wrap')).not.toHaveCount(0);

  await page.getByLabel('Compare with').selectOption({ index: 1 });
  await expect(report).toContainText('Other');
  const time = report.getByRole('row', { name: /^Time/ });
  await expect(time.locator('.better')).toHaveCount(1);
  await expect(page.getByText('better by more than 5 %')).toBeVisible();
  await expect(page.getByText(/^This: \d+ s · /)).toBeVisible();
  await expect(page.getByText(/^Other: \d+ s · /)).toBeVisible();
  await expect(page.getByText('Off the path, cm (left +)')).toBeVisible();
  // The lines of both have the colours of the page, also when the device turns dark meanwhile.
  await expect.poll(() => plotted(page)).toEqual([true, true]);
  await page.emulateMedia({ colorScheme: 'dark' });
  await expect.poll(() => plotted(page)).toEqual([true, true]);
  await page.emulateMedia({ colorScheme: 'light' });
  expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(390);

  await press(page, 'All runs');
  await expect(list.getByRole('button')).toHaveCount(2);

  // Both in one picture, though of two missions.
  await press(page, 'Several in one picture…');
  await expect(page.getByRole('checkbox')).toHaveCount(2);
  await page.getByRole('checkbox').nth(1).check();
  await press(page, 'Show 2 runs');
  await expect(page.getByText(/^Squares of 25 cm|^Squares of 0\.25 m/)).toBeVisible();
});

test('a run that is opened under way goes on, and says when it is finished', async ({
  page,
  station,
}) => {
  test.setTimeout(180_000);
  await open_page(page, station.url);
  await arm(page);
  await begin(station, 'Slow bend', 0.5);
  await tab(page, 'Missions');
  await press(page, 'Runs');
  await page.getByRole('button', { name: /^Slow bend Under way/ }).click();
  const panel = page.locator('#panel');
  await expect(panel).toContainText('· Under way');
  await expect(panel).toContainText('· Finished', { timeout: 90_000 });
  await expect(page.getByRole('row', { name: /^Driven/ })).toContainText(/1\d\.\d m/);

  await press(page, 'All runs');
  await expect(page.getByRole('list', { name: 'Runs' })).toContainText('Finished');
});
