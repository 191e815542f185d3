// A start tells beforehand what it will do, beside the map; and arming is no slip of the thumb.

import { arm, open_page, press } from './page';
import { expect, test } from './station';

test('a tap does not arm, a held Enter does', async ({ page, station }) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await open_page(page, station.url);
  const button = page.getByRole('button', { name: 'Arm', exact: true });
  const ready = page.getByRole('region', { name: 'Before arming' });
  await expect(ready).toContainText('Ready to arm', { timeout: 30_000 });
  await button.click();
  await expect(page.getByText('Hold it for a second.')).toBeVisible();
  expect(await station.rest('GET', '/vehicle')).toMatchObject({ armed: false });
  // On a busy machine the link may be late just then, which ends the hold.
  await expect(async () => {
    await button.focus();
    await page.keyboard.down('Enter');
    await page.waitForTimeout(1200);
    await page.keyboard.up('Enter');
    await expect(page.getByRole('button', { name: 'Disarm' })).toBeVisible({ timeout: 1500 });
  }).toPass({ timeout: 30_000 });
  expect(await station.rest('GET', '/vehicle')).toMatchObject({ armed: true });
});

test.describe('with a finger', () => {
  test.use({ viewport: { width: 390, height: 844 }, hasTouch: true });

  //   Where Arm was held, Disarm stands when the finger is lifted.
  test('a held Arm stays armed when it is let go', async ({ page, station }) => {
    await open_page(page, station.url);
    const ready = page.getByRole('region', { name: 'Before arming' });
    await expect(ready).toContainText('Ready to arm', { timeout: 30_000 });
    const session = await page.context().newCDPSession(page);
    const touch = (type: 'touchStart' | 'touchEnd', at?: { x: number; y: number }) =>
      session.send('Input.dispatchTouchEvent', { type, touchPoints: at ? [at] : [] });
    const hold = (): Promise<void> =>
      expect(async () => {
        const box = await page.getByRole('button', { name: 'Arm', exact: true }).boundingBox();
        if (!box) throw new Error('no button to hold');
        await touch('touchStart', { x: box.x + box.width / 2, y: box.y + box.height / 2 });
        await expect(page.getByRole('button', { name: 'Disarm' })).toBeVisible({ timeout: 3000 });
        await page.waitForTimeout(200);
        await touch('touchEnd');
      }).toPass({ timeout: 30_000 });
    await hold();
    await page.waitForTimeout(1000);
    expect(await station.rest('GET', '/vehicle')).toMatchObject({ armed: true });
    await page.getByRole('button', { name: 'Disarm' }).tap();
    await expect(page.getByRole('button', { name: 'Arm', exact: true })).toBeVisible();
    // A tap of its own counts, however soon it comes.
    await hold();
    await page.getByRole('button', { name: 'Disarm' }).tap();
    await expect(page.getByRole('button', { name: 'Arm', exact: true })).toBeVisible();
  });
});

test('what keeps it from arming is a light with its cure', async ({ page, station }) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await open_page(page, station.url);
  await press(page, 'Emergency stop');
  const ready = page.getByRole('region', { name: 'Before arming' });
  await expect(ready).toContainText('Not ready to arm');
  await expect(ready).toContainText('When the area around it is clear, reset the stop.');
  await ready.getByRole('button', { name: 'Reset stop' }).click();
  await page.getByRole('dialog').getByRole('button', { name: 'Reset' }).click();
  await expect(ready).not.toContainText('reset the stop');
});

test('where no fix is heard it is armed to be driven by hand, and nothing else drives', async ({
  page,
  station,
}) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await open_page(page, station.url);
  const ready = page.getByRole('region', { name: 'Before arming' });
  const by_hand = ready.getByRole('button', { name: 'Arm to drive by hand' });
  await expect(ready).toContainText('Ready to arm', { timeout: 30_000 });
  await expect(by_hand).toHaveCount(0);
  station.sim.tell({ set: { gnss_outage: true } });
  await expect(by_hand).toBeVisible({ timeout: 20_000 });
  await expect(async () => {
    await by_hand.focus();
    await page.keyboard.down('Enter');
    await page.waitForTimeout(1200);
    await page.keyboard.up('Enter');
    await expect(page.getByRole('button', { name: 'Disarm' })).toBeVisible({ timeout: 1500 });
  }).toPass({ timeout: 30_000 });
  expect(await station.rest('GET', '/vehicle')).toMatchObject({ armed: true, armed_by_hand: true });
  await press(page, 'MANUAL');
  await expect.poll(() => station.rest('GET', '/vehicle')).toMatchObject({ mode: 'MANUAL' });
  await expect(station.rest('PUT', '/vehicle/mode', { mode: 'GUIDED' })).rejects.toThrow(
    /by hand only/,
  );
});

test('a start shows its first way, the way home, the fence and its end, and covers no map', async ({
  page,
  station,
}) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await open_page(page, station.url);
  const { lat, lon } = station.sim.now;
  const items = [1, 2].map((k) => ({ type: 'waypoint', lat: lat + k * 0.0001, lon }));
  const made = { name: 'North', items };
  const { id } = await station.rest<{ id: string }>('POST', '/missions', made);
  await station.rest('PUT', '/vehicle/home', { lat, lon: lon - 0.0002 });
  await arm(page);
  await station.rest('POST', '/execution/load', { mission_id: id });
  const hold = page.getByRole('button', { name: 'HOLD', exact: true });
  const before = await hold.boundingBox();
  await press(page, 'Start…');
  const card = page.getByRole('dialog', { name: 'Start the mission?' });
  const lights = card.getByRole('list', { name: 'Before it moves' }).getByRole('listitem');
  // What speaks against it comes first.
  await expect(lights).toContainText([
    /Fence\s*none holds/,
    /Heading\s*±\d/,
    /To its first item\s*11\.\d m, (000|359|001)° N/,
    /Check\s*nothing speaks against it/,
    /Way home\s*Home, 1[12]\.\d m/,
    /Position\s*RTK fixed, ±\d cm/,
  ]);
  await expect(card).toContainText(/At the end it\s*stops and holds/);
  const box = await card.boundingBox();
  expect(box?.y).toBeGreaterThan(844 / 3);
  expect(await hold.boundingBox()).toEqual(before);
  await card.getByRole('button', { name: 'Cancel' }).click();
  await expect(card).toBeHidden();
  expect(await station.rest('GET', '/execution')).toMatchObject({ state: 'loaded' });
});
