// The page over links as the field has them: slow, standing still, half dead. What it shows is as old
// as it says, what stops the robot gets through, and nothing late moves it.

import type { Page } from '@playwright/test';

import { arm, map_middle, metres_between, open_page, press } from './page';
import { expect, test, type Station } from './station';

interface Vehicle {
  readonly mode: string;
  readonly armed: boolean;
  readonly estop: boolean;
  readonly activity: { readonly state: string };
  readonly mission: { readonly state: string };
}
const vehicle = (station: Station): Promise<Vehicle> => station.rest('GET', '/vehicle');
const mode = (station: Station): Promise<string> => vehicle(station).then((v) => v.mode);

const figure = async (page: Page, pattern: RegExp): Promise<number> => {
  const text = await page.getByRole('group', { name: 'Link' }).innerText();
  const found = pattern.exec(text.replaceAll('\n', ' '));
  if (!found) throw new Error(`no ${String(pattern)} in “${text}”`);
  return Number(found[1]) * (found[2] === 'ms' ? 0.001 : 1);
};
const round_trip_s = (page: Page): Promise<number> => figure(page, /⇄ ([\d.]+) (m?s)/);
const age_s = (page: Page): Promise<number> => figure(page, /([\d.]+) (s)$/);

const halt_line = (page: Page) => page.getByRole('alert', { name: 'Halt' });
const link_cell = (page: Page) => page.getByRole('group', { name: 'Link' });

/** A mission far to the north, under way. */
const begin_mission = async (station: Station, page: Page): Promise<void> => {
  const { lat, lon } = station.sim.now;
  const items = [1, 2, 3].map((k) => ({ type: 'waypoint', lat: lat + k * 0.0004, lon }));
  const made = { name: 'North', items };
  const { id } = await station.rest<{ id: string }>('POST', '/missions', made);
  await arm(page);
  await station.rest('POST', '/execution/load', { mission_id: id });
  await station.rest('POST', '/execution/start', { mission_id: id, revision: 1 });
  await expect(page.getByLabel('Mission state')).toHaveText('Running');
};

const CASES = [
  { delay_ms: 0, word: 'Live', grey: false, least_s: 0, most_s: 0.5, halt_within_ms: 1500 },
  { delay_ms: 500, word: 'Slow', grey: false, least_s: 0.5, most_s: 0.95, halt_within_ms: 3000 },
  { delay_ms: 2000, word: 'Late', grey: true, least_s: 2, most_s: 3.2, halt_within_ms: 7000 },
];
for (const { delay_ms, word, grey, least_s, most_s, halt_within_ms } of CASES) {
  test(`with ${delay_ms} ms each way the page tells age and round trip, and HOLD gets through`, async ({
    page,
    station,
    link,
  }) => {
    test.setTimeout(120_000);
    await open_page(page, link.url);
    await arm(page);
    await press(page, 'MANUAL');
    await expect.poll(() => mode(station)).toBe('MANUAL');

    link.delay(delay_ms);
    await expect(link_cell(page)).toContainText(word, { timeout: 20_000 });
    await expect
      .poll(() => round_trip_s(page), { timeout: 20_000 })
      .toBeGreaterThanOrEqual((2 * delay_ms) / 1000);
    // It is that of the data all the time, not of the last message.
    for (let k = 0; k < 8; k += 1) {
      const shown_s = await age_s(page);
      expect(shown_s).toBeGreaterThanOrEqual(least_s);
      expect(shown_s).toBeLessThanOrEqual(most_s);
      await expect(link_cell(page)).toContainText(word);
      await page.waitForTimeout(150);
    }
    await expect(link_cell(page)).toHaveAttribute('data-stale', String(grey));
    const card = page.getByRole('region', { name: 'Mission' });
    await expect(card).toHaveAttribute('data-stale', String(grey));
    if (grey) {
      await expect(card).toContainText(/2\.\d s old/);
      await expect(page.getByRole('button', { name: 'MANUAL', exact: true })).toHaveAttribute(
        'title',
        /too old to act upon/,
      );
    }

    const pressed = performance.now();
    await press(page, 'HOLD');
    // It is shown no longer than the way there and back lasts.
    await Promise.all([
      expect.poll(() => mode(station), { timeout: halt_within_ms }).toBe('HOLD'),
      delay_ms > 300 ? expect(halt_line(page)).toContainText('not confirmed yet') : null,
    ]);
    if (delay_ms > 300) {
      await expect(halt_line(page)).toContainText('HOLD confirmed', { timeout: 10_000 });
      expect(performance.now() - pressed).toBeGreaterThan(2 * delay_ms);
    }
    await expect(halt_line(page)).toBeHidden({ timeout: 10_000 });
  });
}

test('a page that is opened over two seconds each way comes up, and says how old all is', async ({
  page,
  link,
}) => {
  test.setTimeout(120_000);
  link.delay(2000);
  await page.goto(link.url, { timeout: 60_000 });
  await expect(link_cell(page)).toContainText('Late', { timeout: 40_000 });
  await expect.poll(() => age_s(page)).toBeGreaterThanOrEqual(2);
  await expect(page.getByText('The link is slow: what you see is old.')).toBeVisible();
});

test('after a second without data everything live is grey with its age, and comes back', async ({
  page,
  station,
  link,
}) => {
  test.setTimeout(120_000);
  await open_page(page, link.url);
  await begin_mission(station, page);
  const live = [
    ...['Link', 'Mode', 'Control', 'Position', 'Speed, m/s', 'Battery'].map((name) =>
      page.getByRole('group', { name, exact: true }).first(),
    ),
    page.getByRole('region', { name: 'Mission' }),
  ];
  for (const part of live) await expect(part).toHaveAttribute('data-stale', 'false');
  // Whoever reaches for one just then still hits it.
  const stop_mission = page.getByRole('button', { name: 'Stop mission', exact: true });
  const place = await stop_mission.boundingBox();

  const begun = performance.now();
  link.stall('down');
  for (const part of live) await expect(part).toHaveAttribute('data-stale', 'true');
  expect(performance.now() - begun).toBeGreaterThan(500);
  for (const name of ['Mode', 'Control', 'Position', 'Speed, m/s', 'Battery']) {
    const cell = page.getByRole('group', { name, exact: true }).first();
    await expect(cell).toContainText(/\d s old/);
  }
  await expect(page.getByRole('region', { name: 'Mission' })).toContainText(/\d s old/);
  await expect(page.getByLabel('Now')).toContainText(/\d s old/);
  await expect(page.getByText('what you see is old')).toBeVisible();
  expect(await stop_mission.boundingBox()).toEqual(place);
  // No age lies on the name of a figure.
  const covered = await page.locator('section.deck dt').evaluateAll((names) =>
    names.filter((name) => {
      const label = name.getBoundingClientRect();
      const age = document.querySelector('section.deck .age')?.getBoundingClientRect();
      return !age || (age.left < label.right && age.right > label.left && age.top < label.bottom);
    }),
  );
  expect(covered).toEqual([]);

  link.go_on();
  for (const part of live) {
    await expect(part).toHaveAttribute('data-stale', 'false', { timeout: 15_000 });
  }
  await expect(page.getByRole('region', { name: 'Mission' })).not.toContainText('old');
});

test('a link on which only the way to the page works is not green', async ({ page, link }) => {
  await open_page(page, link.url);
  link.stall('up');
  await expect(link_cell(page)).toContainText('Unheard');
  await expect.poll(() => round_trip_s(page)).toBeGreaterThan(2);
  await expect(page.getByText('The robot is seen but does not answer')).toBeVisible();
  link.go_on();
  await expect(link_cell(page)).toContainText('Live');
});

test('whatever stops goes out at once while another command waits for its answer', async ({
  page,
  station,
  link,
}) => {
  test.setTimeout(120_000);
  await open_page(page, link.url);
  await begin_mission(station, page);
  link.hangs = /^POST \/api\/v1\/execution\/skip/;
  const state = (): Promise<string> => vehicle(station).then((v) => v.mission.state);

  for (const [button, expected] of [
    ['Pause', 'paused'],
    ['HOLD', 'paused'],
    ['Stop mission', 'aborted'],
  ] as const) {
    if (button === 'HOLD') {
      // The page repeats Pause for as long as the skip before it may still be obeyed: a resume
      // within that second is undone, as it should be.
      await page.waitForTimeout(1500);
      await station.rest('POST', '/execution/resume');
      await expect(page.getByLabel('Mission state')).toHaveText('Running');
    }
    await press(page, 'Skip item');
    await press(page, button);
    await expect.poll(state, { timeout: 1500, message: button }).toBe(expected);
  }
  await press(page, 'Disarm');
  await expect
    .poll(() => vehicle(station).then((v) => v.armed), { timeout: 1500, message: 'Disarm' })
    .toBe(false);
  await press(page, 'Emergency stop');
  await expect
    .poll(() => vehicle(station).then((v) => v.estop), { timeout: 1500, message: 'STOP' })
    .toBe(true);
});

test('HOLD needs none of the browser’s six connections', async ({ page, station, link }) => {
  await open_page(page, link.url);
  await arm(page);
  await press(page, 'MANUAL');
  await expect.poll(() => mode(station)).toBe('MANUAL');
  link.hangs = /^GET \/api\/v1\/missions\?hang/;
  await page.evaluate(() => {
    for (let k = 0; k < 12; k += 1) void fetch(`/api/v1/missions?hang=${k}`).catch(() => undefined);
  });
  await page.waitForTimeout(300);
  await press(page, 'HOLD');
  await expect.poll(() => mode(station), { timeout: 1500 }).toBe('HOLD');
});

test('STOP gets through when every open connection is dead and nobody was told', async ({
  page,
  station,
  link,
}) => {
  await open_page(page, link.url);
  link.lose_open_connections();
  await press(page, 'Emergency stop');
  await expect.poll(() => vehicle(station).then((v) => v.estop), { timeout: 5000 }).toBe(true);
  await expect(page.getByRole('button', { name: 'Emergency stop' })).toHaveText('STOPPED', {
    timeout: 15_000,
  });
});

test('what ended the driving while the page was away is said when it is back', async ({
  page,
  station,
  link,
}) => {
  test.setTimeout(150_000);
  await open_page(page, link.url);
  await arm(page);
  await press(page, 'MANUAL');
  await expect.poll(() => mode(station)).toBe('MANUAL');
  link.lose_open_connections();
  await station.rest('PUT', '/vehicle/mode', { mode: 'HOLD' });
  // The page finds out within some seconds. What it asks then does not wait behind what is lost, whatever
  // dead connections the browser still holds for good ones.
  const said = page.getByText(/^Meanwhile: .*mode HOLD/);
  await expect(said).toBeVisible({ timeout: 10_000 });
  // It stays until somebody has read it; what the page saw itself is not said again.
  await page.waitForTimeout(9000);
  await expect(said).toHaveCount(1);
  await page.reload();
  await expect(link_cell(page)).toContainText('Live');
  await expect(page.getByText(/^Meanwhile/)).toHaveCount(0);
});

test('a stop on a link that stands still is repeated, shown so, and confirmed when it goes on', async ({
  page,
  station,
  link,
}) => {
  await open_page(page, link.url);
  await arm(page);
  await press(page, 'MANUAL');
  link.stall('up', 'down');
  await press(page, 'HOLD');
  await press(page, 'Emergency stop');
  const hold = halt_line(page).filter({ hasText: 'HOLD' });
  await expect(hold).toContainText(/HOLD: stopping….*not confirmed yet, 3rd try/s);
  await expect(page.getByRole('button', { name: 'Emergency stop' })).toHaveText(/^STOPPING \d/);
  await expect(hold).toContainText('Use the button on the robot or the radio.');
  expect(await vehicle(station)).toMatchObject({ estop: false });

  link.go_on();
  await expect.poll(() => vehicle(station).then((v) => v.estop), { timeout: 5000 }).toBe(true);
  await expect(hold).toContainText(/confirmed|Give up/, { timeout: 15_000 });
  await expect(page.getByRole('button', { name: 'Emergency stop' })).toHaveText('STOPPED', {
    timeout: 15_000,
  });
});

test('a click that comes late is not obeyed, and the page says why', async ({
  page,
  station,
  link,
}) => {
  test.setTimeout(90_000);
  await open_page(page, link.url);
  await arm(page);
  const start = station.sim.now;
  const [x, y] = await map_middle(page);
  await page.mouse.click(x + 80, y - 60);
  await expect(page.getByLabel('Chosen place')).toBeVisible();

  link.stall('up');
  await press(page, 'Go here');
  await expect(page.getByRole('alert', { name: 'Not known' })).toContainText('Watch the robot');
  await page.waitForTimeout(1000);
  link.go_on();

  const refused = page.getByRole('alert', { name: 'Refused' });
  await expect(refused).toContainText('Go here refused');
  await expect(refused).toContainText('too late');
  await expect(page.getByRole('alert', { name: 'Not known' })).toBeHidden();
  await page.waitForTimeout(2000);
  expect(metres_between(start, station.sim.now)).toBeLessThan(0.05);
  expect((await vehicle(station)).mode).toBe('HOLD');
});

test('a command that was obeyed while its answer was lost is told as obeyed', async ({
  page,
  station,
  link,
}) => {
  test.setTimeout(90_000);
  await open_page(page, link.url);
  await arm(page);
  await page.getByRole('button', { name: 'Disarm', exact: true }).click();
  const button = page.getByRole('button', { name: 'Arm', exact: true });
  await expect(button).toBeEnabled();

  // Shortly before the hold is long enough: the page does not know of it yet.
  const hold_ms = Number(await button.getAttribute('data-hold'));
  await button.hover();
  await page.mouse.down();
  await page.waitForTimeout(hold_ms - 300);
  link.stall('down');
  await page.waitForTimeout(700);
  await page.mouse.up();
  await expect.poll(() => vehicle(station).then((v) => v.armed)).toBe(true);
  const doubt = page.getByRole('alert', { name: 'Not known' });
  await expect(doubt).toContainText('Arm: not known. Watch the robot.');
  await page.waitForTimeout(5000); // the page has given up waiting
  await expect(page.getByRole('alert', { name: 'Refused' })).toBeHidden();

  link.go_on();
  await expect(doubt).toContainText('Arm was obeyed', { timeout: 20_000 });
  await expect(doubt).toContainText('the robot is armed');
});

test('a stick over a slow link does not move the robot, and the pad says why', async ({
  page,
  station,
  link,
}) => {
  test.setTimeout(90_000);
  await open_page(page, link.url);
  await arm(page);
  await press(page, 'MANUAL');
  const start = station.sim.now;
  link.delay(350);
  await expect(link_cell(page)).toContainText('Slow');
  const pad = await page.getByLabel(/^Drive pad/).boundingBox();
  if (!pad) throw new Error('no drive pad');
  const [x, y] = [pad.x + pad.width / 2, pad.y + pad.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x, y - pad.height * 0.45, { steps: 5 });
  await expect(page.getByText(/^Not obeyed: .*too late/)).toBeVisible();
  await page.waitForTimeout(1500);
  await page.mouse.up();
  expect(metres_between(start, station.sim.now)).toBeLessThan(0.05);
});
