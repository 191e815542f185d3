// Several robots are open in several tabs: name, colour and picture tell them apart, and nothing of
// that stands in the way of the stop button.

import { mkdirSync } from 'node:fs';
import { join } from 'node:path';

import { expect, test } from './station';

test.use({ more: ['--set', 'robot.name=kask of the north field', '--set', 'robot.colour=purple'] });

const SIZES = [
  { width: 390, height: 844 },
  { width: 844, height: 390 },
  { width: 1440, height: 900 },
] as const;

test('the robot’s name and colour stand at the head, in the title and in the tab', async ({
  page,
  station,
}) => {
  await page.goto(station.url);
  await expect(page).toHaveTitle('kask of the north field – roverd');
  await expect(page.locator('link[rel="icon"]')).toHaveAttribute('href', '/robot.svg');
  const name = page.getByText('kask of the north field', { exact: true });
  const stop = page.getByRole('button', { name: /emergency stop/i });
  const folder = join(__dirname, 'results/shots');
  mkdirSync(folder, { recursive: true });
  for (const size of SIZES) {
    await page.setViewportSize(size);
    await expect(name).toBeInViewport();
    await expect(stop).toBeInViewport({ ratio: 1 });
    const [head, button] = [await name.boundingBox(), await stop.boundingBox()];
    if (!head || !button) throw new Error('name or stop button has no place');
    expect(head.y + head.height <= button.y || head.x >= button.x + button.width).toBe(true);
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    expect(wide).toBeLessThanOrEqual(size.width);
    await page.screenshot({ path: join(folder, `identity-${size.width}x${size.height}.png`) });
  }
});
