// What must hold when things go wrong: stop, stale data, refusals in the robot's words.

import { draw, drive_it, metres_between, open_page, press, press_it, save, tab } from './page';
import { expect, test } from './station';

const FAR = [
  [0, -180],
  [0, -330],
] as const;

const drive_north = async (page: Parameters<typeof open_page>[0]): Promise<void> => {
  await tab(page, 'Plan');
  await draw(page, FAR);
  await save(page);
  await drive_it(page);
};

/** Once the checks allow it. */
const arm = async (page: Parameters<typeof open_page>[0]): Promise<void> => {
  await expect(async () => {
    const disarm = page.getByRole('button', { name: 'Disarm', exact: true });
    if (!(await disarm.isVisible())) await press(page, 'Arm');
    await expect(disarm).toBeVisible({ timeout: 1000 });
  }).toPass({ timeout: 20_000 });
};

test('the stop button stops the moving robot, latches, and is reset after a question', async ({
  page,
  station,
}) => {
  test.setTimeout(120_000);
  await open_page(page, station.url);
  await drive_north(page);
  await expect.poll(() => station.sim.now.speed_mps, { timeout: 30_000 }).toBeGreaterThan(0.3);

  await press(page, 'Emergency stop');

  await expect
    .poll(() => Math.abs(station.sim.now.speed_mps), { timeout: 3000 })
    .toBeLessThan(0.01);
  await expect(page.getByText('Emergency stop is latched.')).toBeVisible();
  await expect(page.getByRole('button', { name: 'Emergency stop' })).toHaveText('STOPPED');
  const resting = station.sim.now;
  await tab(page, 'Drive');
  await expect(page.getByRole('button', { name: 'Arm', exact: true })).toHaveAttribute(
    'title',
    /latched/,
  );
  await page.waitForTimeout(1000);
  expect(metres_between(resting, station.sim.now)).toBeLessThan(0.05);

  // The checks have such a button, too.
  await press_it(page.getByRole('alert').getByRole('button', { name: 'Reset stop' }));
  await page.getByRole('dialog').getByRole('button', { name: 'Reset', exact: true }).click();
  await expect(page.getByText('Emergency stop is latched.')).toBeHidden();
  await expect(page.getByRole('button', { name: 'Emergency stop' })).toHaveText('STOP');
});

test('the stop button stops before the page is there, and goes on until it is confirmed', async ({
  page,
  station,
}) => {
  let let_page_come = (): void => undefined;
  const may_come = new Promise<void>((done) => (let_page_come = done));
  await page.route(/\/assets\/main-.*\.js$/, async (route) => {
    await may_come;
    await route.continue();
  });
  // The first tries are lost.
  let lost = 0;
  await page.route('**/api/v1/vehicle/estop', (route) => {
    lost += 1;
    return lost <= 2 ? route.abort() : route.continue();
  });
  await page.goto(station.url, { waitUntil: 'commit' });
  const stop = page.getByRole('button', { name: 'Emergency stop' });

  await stop.click();
  await expect(stop).toHaveText('STOP ✓');
  const at_first = await stop.boundingBox();
  expect(lost).toBe(3);
  expect(await station.rest<{ estop: boolean }>('GET', '/vehicle')).toMatchObject({ estop: true });
  // Nothing is said of the robot meanwhile.
  await expect(page.getByRole('group', { name: 'Link' })).toHaveCount(0);

  let_page_come();
  await expect(page.getByRole('group', { name: 'Link' })).toContainText('Live');
  await expect(stop).toHaveText('STOPPED');
  // It has not moved under the finger.
  expect(await stop.boundingBox()).toEqual(at_first);
});

test('drivers are listed with what they say, and one is restarted after a question', async ({
  page,
  station,
}) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await open_page(page, station.url);
  await tab(page, 'Log');
  const bunker = page.getByRole('listitem', { name: 'Driver bunker' });
  await expect(bunker).toContainText(/Up.*heard .* ago/s);

  await bunker.getByText('Details').click();
  await expect(bunker).toContainText('0x221');
  const width = await page.evaluate(() => document.documentElement.scrollWidth);
  expect(width).toBeLessThanOrEqual(390);

  await bunker.getByRole('button', { name: 'Restart' }).click();
  await page.getByRole('dialog').getByRole('button', { name: 'Restart', exact: true }).click();

  await expect(bunker).toContainText('restarted once');
  await expect(bunker).toContainText('Up');
});

test('Esc closes a dialog and never stops the robot; Space does, and F8 also while one types', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  const stop = page.getByRole('button', { name: 'Emergency stop' });
  const latched = async (): Promise<boolean> =>
    (await station.rest<{ estop: boolean }>('GET', '/vehicle')).estop;
  await tab(page, 'Log');
  await press(page, 'Keys');
  await expect(page.getByRole('dialog')).toContainText('Emergency stop');
  await page.keyboard.press('Escape');
  await expect(page.getByRole('dialog')).toBeHidden();
  await page.keyboard.press('Escape'); // once more, as people do
  await page.waitForTimeout(500);
  expect(await latched()).toBe(false);

  await press(page, 'Keys');
  await page.keyboard.press('Space');
  await expect(stop).toHaveText('STOPPED');
  await page.keyboard.press('Escape');
  await press(page, 'Reset stop');
  await page.getByRole('dialog').getByRole('button', { name: 'Reset', exact: true }).click();
  await expect(stop).toHaveText('STOP');

  await tab(page, 'Plan');
  await page.getByLabel('Mission name').fill('Row ');
  await page.keyboard.press('Space');
  await page.waitForTimeout(500);
  expect(await latched()).toBe(false);
  await page.keyboard.press('F8');
  await expect(stop).toHaveText('STOPPED');
});

test('a lost GNSS receiver shows: the value is marked stale with its age, and comes back', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  const position = page.getByRole('group', { name: 'Position' });
  station.sim.tell({ set: { gnss_silent: true } });
  await expect(position).toHaveAttribute('data-stale', 'true', {
    timeout: 15_000,
  });
  await expect(position).toContainText('old');
  station.sim.tell({ set: { gnss_silent: false } });
  await expect(position).toHaveAttribute('data-stale', 'false', {
    timeout: 20_000,
  });
});

test('a receiver without a fix says so in words', async ({ page, station }) => {
  await open_page(page, station.url);
  const position = page.getByRole('group', { name: 'Position' });
  await expect(position).toContainText('RTK fixed');
  station.sim.tell({ set: { gnss_outage: true } });
  await expect(position).toContainText('No fix');
  station.sim.tell({ set: { gnss_outage: false } });
  await expect(position).toContainText('RTK fixed', { timeout: 20_000 });
});

test('an open but silent stream shows: all is marked old, driving is refused, it recovers', async ({
  page,
  station,
}) => {
  let silent = false;
  await page.routeWebSocket(/stream/, (socket) => {
    const server = socket.connectToServer();
    server.onMessage((message) => {
      if (!silent) socket.send(message);
    });
  });
  await open_page(page, station.url);
  silent = true;
  const link = page.getByRole('group', { name: 'Link' });
  await expect(link).toHaveAttribute('data-stale', 'true');
  await expect(page.getByRole('group', { name: 'Battery' })).toHaveAttribute('data-stale', 'true');
  await expect(page.getByText('what you see is old')).toBeVisible();
  await expect(page.getByRole('button', { name: 'Arm', exact: true })).toHaveAttribute(
    'title',
    'No live connection to the robot.',
  );

  // STOP does not need the stream.
  await press(page, 'Emergency stop');
  await expect
    .poll(async () => (await station.rest<{ estop: boolean }>('GET', '/vehicle')).estop)
    .toBe(true);

  silent = false;
  await expect(link).toHaveAttribute('data-stale', 'false', {
    timeout: 15_000,
  });
});

test('a refused arming lists the failing checks in words', async ({ page, station }) => {
  await open_page(page, station.url);
  station.sim.tell({ set: { gnss_silent: true } });
  await expect(page.getByRole('group', { name: 'Position' })).toHaveAttribute(
    'data-stale',
    'true',
    {
      timeout: 15_000,
    },
  );
  await press(page, 'Arm');
  const refused = page.getByRole('alert', { name: 'Refused' });
  await expect(refused).toContainText('Arm refused');
  await expect(refused.getByRole('listitem').first()).toBeVisible();
});

test('Esc closes what is pulled out in the Drive panel, one after the other, and stops nothing', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  const card = (name: string) => page.getByRole('region', { name, exact: true });
  for (const name of ['Come home', 'Move, turn', 'Come to me']) await press(page, name);
  for (const name of ['Come home', 'Move and turn', 'Come to me']) {
    await expect(card(name)).toBeVisible();
  }
  await page.keyboard.press('Escape');
  await expect(card('Come home')).toBeHidden();
  await page.keyboard.press('Escape');
  await expect(card('Come to me')).toBeHidden();
  await expect(card('Move and turn')).toBeVisible();
  await page.keyboard.press('Escape');
  await expect(card('Move and turn')).toBeHidden();
  for (const name of ['Record', 'Calibrate the vehicle']) {
    const button = page.getByRole('button', { name, exact: true });
    await press_it(button);
    await expect(button).toHaveAttribute('aria-pressed', 'true');
    await page.keyboard.press('Escape');
    await expect(button).toHaveAttribute('aria-pressed', 'false');
  }
  const { estop } = await station.rest<{ estop: boolean }>('GET', '/vehicle');
  expect(estop).toBe(false);
});

test('driving by hand moves the robot while held, and letting go stops it', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  await arm(page);
  await press(page, 'MANUAL');
  const pad = page.getByLabel(/^Drive pad/);
  const box = await pad.boundingBox();
  if (!box) throw new Error('no drive pad');
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  // While nobody pushes, the page says so: only then may a stick act.
  const stick = async (): Promise<string> =>
    (await station.rest<{ teleop: { state: string } }>('GET', '/vehicle')).teleop.state;
  await expect.poll(stick, { timeout: 10_000 }).toBe('ready');

  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x, y - box.height * 0.45, { steps: 5 });
  await expect.poll(() => station.sim.now.speed_mps, { timeout: 10_000 }).toBeGreaterThan(0.2);
  await expect(page.getByRole('group', { name: 'Control' })).toContainText('Page drives');

  await page.mouse.up();
  await expect
    .poll(() => Math.abs(station.sim.now.speed_mps), { timeout: 3000 })
    .toBeLessThan(0.01);
});

test('a pad that is pushed away under a still thumb commands what it did', async ({
  page,
  station,
}) => {
  await page.setViewportSize({ width: 820, height: 1180 });
  await open_page(page, station.url);
  await arm(page);
  await press(page, 'MANUAL');
  const pad = page.getByLabel(/^Drive pad/);
  const wish = page.getByLabel('Drive by hand').locator('p.number');
  await page.waitForTimeout(1000);
  await pad.scrollIntoViewIfNeeded();
  const box = await pad.boundingBox();
  if (!box) throw new Error('no drive pad');
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x, y - 50, { steps: 5 });
  const before = await wish.innerText();
  expect(before).not.toMatch(/^0\.00/);

  // As a line does that appears above it.
  await pad.evaluate((node) => {
    node
      .closest('section')
      ?.insertAdjacentHTML('beforebegin', '<p style="height: 60px">a line</p>');
  });
  const moved = await pad.boundingBox();
  expect(Math.abs((moved?.y ?? 0) - box.y)).toBeGreaterThan(20);
  await page.mouse.move(x + 0.6, y - 50);
  await page.mouse.move(x, y - 50);
  expect(await wish.innerText()).toBe(before);
  await page.mouse.up();
  await expect(wish).toHaveText(/^0\.00/);
});

test('the space key stops in a list and in a number, and is a blank where words are typed', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  await tab(page, 'Plan');
  await draw(page, FAR);
  const stop = page.getByRole('button', { name: 'Emergency stop' });
  const name = page.getByRole('textbox', { name: 'Mission name' });
  await name.fill('Two');
  await name.press('Space');
  await expect(name).toHaveValue('Two ');
  for (const field of [
    page.locator('main select'),
    page.locator('main input[inputmode=decimal]'),
  ]) {
    await expect(stop).toHaveText('STOP');
    await field.first().focus();
    await page.keyboard.press('Space');
    await expect(stop).toHaveText('STOPPED');
    await station.rest('POST', '/vehicle/estop/reset', {});
  }
});

test('a key that is held while the mode changes moves nothing until it is pressed anew', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  await arm(page);
  await press(page, 'MANUAL');
  const pad = page.getByLabel(/^Drive pad/);
  await pad.focus();
  const speed = (): number => station.sim.now.speed_mps;
  await page.waitForTimeout(500);
  await page.keyboard.down('ArrowUp');
  await expect.poll(speed, { timeout: 10_000 }).toBeGreaterThan(0.2);
  await station.rest('PUT', '/vehicle/mode', { mode: 'HOLD' });
  await expect.poll(() => Math.abs(speed()), { timeout: 5000 }).toBeLessThan(0.01);
  await station.rest('PUT', '/vehicle/mode', { mode: 'MANUAL' });
  const from = station.sim.now;
  await pad.focus();
  // The keyboard repeats it all the time.
  for (let i = 0; i < 20; i += 1) {
    await page.keyboard.down('ArrowUp');
    await page.waitForTimeout(100);
  }
  expect(metres_between(from, station.sim.now)).toBeLessThan(0.02);
  await page.keyboard.up('ArrowUp');
  await page.waitForTimeout(500);
  await page.keyboard.down('ArrowUp');
  await expect.poll(speed, { timeout: 10_000 }).toBeGreaterThan(0.2);
  await page.keyboard.up('ArrowUp');
});

test('after a jump of the position the robot holds until somebody says that he has looked', async ({
  page,
  station,
}) => {
  test.setTimeout(150_000);
  await open_page(page, station.url);
  await drive_north(page);
  await page.setViewportSize({ width: 390, height: 844 });
  await expect.poll(() => station.sim.now.speed_mps, { timeout: 30_000 }).toBeGreaterThan(0.3);

  station.sim.tell({ set: { gnss_jump_east_m: 60 } });

  const looked = page.getByRole('button', { name: 'I have looked' });
  await expect(looked).toBeVisible({ timeout: 60_000 });
  await expect
    .poll(() => Math.abs(station.sim.now.speed_mps), { timeout: 5000 })
    .toBeLessThan(0.01);

  // The alert says it; no message says it once more over the map.
  await expect(
    page.getByRole('log', { name: 'Messages' }).getByText('look where the robot stands'),
  ).toBeHidden();
  await looked.click();
  await page.getByRole('dialog').getByRole('button', { name: 'I have looked' }).click();
  await expect(looked).toBeHidden();
});

test('after the base was moved somebody says which place counts, and the robot drives on', async ({
  page,
  station,
}) => {
  test.setTimeout(150_000);
  await open_page(page, station.url);
  await drive_north(page);
  await page.setViewportSize({ width: 390, height: 844 });
  await expect.poll(() => station.sim.now.speed_mps, { timeout: 30_000 }).toBeGreaterThan(0.3);

  station.sim.tell({ set: { gnss_base_shift_east_m: 3 } });

  const keep = page.getByRole('button', { name: 'Keep old place' });
  await expect(keep).toBeVisible({ timeout: 60_000 });
  await expect(page.getByRole('button', { name: 'Take new place' })).toBeVisible();
  await expect
    .poll(() => Math.abs(station.sim.now.speed_mps), { timeout: 5000 })
    .toBeLessThan(0.01);
  await keep.click();
  await page.getByRole('dialog').getByRole('button', { name: 'Keep' }).click();
  await expect(keep).toBeHidden();
});
