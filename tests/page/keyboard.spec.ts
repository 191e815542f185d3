// The phone's own keyboard: it makes the page smaller, or is laid over it. STOP is seen all the same.

import { open_page, tab } from './page';
import { expect, test } from './station';

test.use({ viewport: { width: 390, height: 844 }, hasTouch: true });

test('the page asks for a keyboard that makes it smaller', async ({ page, station }) => {
  await page.goto(station.url);
  const words = await page.locator('meta[name=viewport]').getAttribute('content');
  expect(words).toContain('interactive-widget=resizes-content');
});

for (const at of ['Plan', 'Drive'] as const) {
  test(`STOP lies above a keyboard that is laid over the page at ${at}`, async ({
    page,
    station,
  }) => {
    await page.addInitScript(() => {
      const seen = Object.assign(new EventTarget(), { height: 844, offsetTop: 0, scale: 1 });
      Object.defineProperty(window, 'visualViewport', { value: seen });
    });
    await open_page(page, station.url);
    await tab(page, at);
    if (at === 'Plan') await page.getByLabel('Mission name').focus();
    const stop = page.getByRole('button', { name: 'Emergency stop' });
    const bottom = async (): Promise<number> => {
      const box = await stop.boundingBox();
      return box ? box.y + box.height : NaN;
    };
    for (const [height, width] of [
      [500, 390],
      [200, 844],
    ] as const) {
      await page.setViewportSize({ width, height: width === 390 ? 844 : 390 });
      await page.evaluate((pixels) => {
        const seen = window.visualViewport as unknown as { height: number } & EventTarget;
        seen.height = pixels;
        seen.dispatchEvent(new Event('resize'));
      }, height);
      await expect.poll(bottom).toBeLessThanOrEqual(height);
      const [x, y] = [width - 60, (await bottom()) - 20];
      const there = await page.evaluate(
        ([px = 0, py = 0]) => document.elementFromPoint(px, py)?.closest('button')?.ariaLabel,
        [x, y],
      );
      expect(there).toBe('Emergency stop');
    }
  });
}
