// A gamepad, as the browser would report it: its dead-man drives, and letting go or pulling it out
// stops at once.

import type { Page } from '@playwright/test';

import { arm, open_page, press } from './page';
import { expect, test } from './station';

interface FakePad {
  axes: number[];
  down: number[];
  /** How far the right trigger is drawn. */
  trigger: number;
  there: boolean;
}

/** Before the page is opened: a gamepad that is not there yet. */
const with_gamepad = async (page: Page): Promise<void> => {
  await page.addInitScript(() => {
    const fake: FakePad = { axes: [0, 0, 0, 0], down: [], trigger: 0, there: false };
    Object.assign(window, { fake });
    const now = (): object => ({
      id: 'Wireless Controller (STANDARD GAMEPAD Vendor: 046d Product: c21f)',
      mapping: 'standard',
      connected: true,
      axes: fake.axes,
      buttons: Array.from({ length: 17 }, (_, k) => ({
        pressed: fake.down.includes(k),
        ...(k === 7 ? { value: fake.trigger } : {}),
      })),
    });
    navigator.getGamepads = () => (fake.there ? [null, now()] : [null]) as (Gamepad | null)[];
  });
};

const hands = (page: Page, change: Partial<FakePad>): Promise<void> =>
  page.evaluate((wanted) => {
    Object.assign((window as unknown as { fake: FakePad }).fake, wanted);
    const gone = wanted.there === false;
    if (gone) window.dispatchEvent(new Event('gamepaddisconnected'));
  }, change);

const LB = 4;
const RB = 5;
const RT = 7;

test('a gamepad drives while its dead-man is held, and is let go when it is pulled out', async ({
  page,
  station,
}) => {
  await with_gamepad(page);
  await open_page(page, station.url);
  await arm(page);
  await press(page, 'MANUAL');
  await hands(page, { there: true });
  await expect(page.getByText('Gamepad: hold LB to drive.')).toBeVisible();

  // A stick alone moves nothing.
  await hands(page, { axes: [0, -1, 0, 0] });
  await page.waitForTimeout(600);
  expect(Math.abs(station.sim.now.speed_mps)).toBeLessThan(0.02);
  // On a busy machine the link may be late just then: the grip ends, and has to be a fresh one.
  const hold = (moves: () => boolean): Promise<void> =>
    expect(async () => {
      await hands(page, { down: [] });
      await page.waitForTimeout(400);
      await hands(page, { down: [LB] });
      await expect.poll(moves, { timeout: 5000 }).toBe(true);
    }).toPass({ timeout: 40_000 });
  await hold(() => station.sim.now.speed_mps > 0.3);
  await hands(page, { down: [] });
  await expect.poll(() => Math.abs(station.sim.now.speed_mps)).toBeLessThan(0.02);

  // To the right is clockwise; pulled out it stands, although the button was never let go.
  await hands(page, { axes: [0, 0, 1, 0] });
  await hold(() => Math.abs(station.sim.now.yaw_rate_dps) > 5);
  await expect(page.getByLabel('Drive by hand')).toContainText(/[1-9][\d.]* °\/s to the right/);
  await hands(page, { there: false });
  await expect.poll(() => Math.abs(station.sim.now.yaw_rate_dps)).toBeLessThan(0.5);
  await expect(page.getByLabel('Messages')).toContainText('The gamepad is gone');
  await hands(page, { there: true });
  await page.waitForTimeout(600);
  expect(Math.abs(station.sim.now.yaw_rate_dps)).toBeLessThan(0.5);
});

test('its buttons are seen and assigned, kept on the device, and both bumpers choose MANUAL', async ({
  page,
  station,
}) => {
  await with_gamepad(page);
  await open_page(page, station.url);
  await arm(page);
  await press(page, 'MANUAL');
  await hands(page, { there: true });
  await press(page, 'Buttons…');
  const card = page.getByRole('region', { name: 'Gamepad' });
  await expect(card).toContainText('Dead-man: LB');
  await press(page, 'Assign dead-man');
  await hands(page, { down: [RT] });
  await expect(card).toContainText('Dead-man: RT');
  await hands(page, { down: [] });
  await card.getByLabel('Both bumpers, held together, choose MANUAL').check();

  await page.reload();
  await hands(page, { there: true });
  await press(page, 'HOLD');
  await expect(page.getByText('Gamepad: hold both bumpers to drive by hand.')).toBeVisible();
  await hands(page, { down: [RT] });
  await page.waitForTimeout(700);
  await expect(page.getByLabel(/^Drive pad/)).toHaveCount(0);
  await hands(page, { down: [RT, RB] });
  await expect(page.getByLabel(/^Drive pad/)).toBeVisible();
});

test('in AUTO it is a dead-man: as fast as the trigger is drawn, and it stops when the pad is lost', async ({
  page,
  station,
}) => {
  await with_gamepad(page);
  await open_page(page, station.url);
  const here = station.sim.now;
  const items = [4, 40].map((north_m) => ({
    type: 'waypoint',
    lat: here.lat + north_m / 111_250,
    lon: here.lon,
    speed_mps: 0.8,
  }));
  const { id } = await station.rest<{ id: string }>('POST', '/missions', { name: 'Lane', items });
  await station.rest('POST', '/execution/load', { mission_id: id });
  await arm(page);
  await hands(page, { there: true });
  await press(page, 'Buttons…');
  await page
    .getByRole('region', { name: 'Gamepad' })
    .getByLabel('AUTO drives only while a bumper is held')
    .check();
  await hands(page, { down: [RB], trigger: 1 });
  await station.rest('POST', '/execution/start', {
    mission_id: id,
    revision: 1,
    valid_for_s: 5,
  });
  const speed = (): number => station.sim.now.speed_mps;
  await expect.poll(speed, { timeout: 20_000 }).toBeGreaterThan(0.65);
  await hands(page, { trigger: 0.5 });
  await expect.poll(speed).toBeLessThan(0.45);
  await expect(page.getByText('As fast as the trigger is drawn').first()).toBeVisible();
  // Let go it stands, and held again it goes on.
  await hands(page, { down: [], trigger: 0 });
  await expect.poll(speed).toBeLessThan(0.02);
  await expect(page.getByText(/hand on the speed was let go/).first()).toBeVisible();
  await hands(page, { down: [RB], trigger: 1 });
  await expect.poll(speed, { timeout: 15_000 }).toBeGreaterThan(0.3);
  // Pulled out it stands, although nothing was let go, and does not drive on by itself.
  await hands(page, { there: false });
  await expect.poll(speed).toBeLessThan(0.02);
  await page.waitForTimeout(1000);
  expect(Math.abs(speed())).toBeLessThan(0.02);
});
