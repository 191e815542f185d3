// What holds on every screen: a glove hits everything that is pressed, and the stop button is whole.

import { expect, type Page } from '@playwright/test';

/** A finger in a glove. */
const LEAST_PX = 48;

interface Box {
  readonly what: string;
  /** Those of one line have the same. */
  readonly line: number;
  readonly x: number;
  readonly y: number;
  readonly width: number;
  readonly height: number;
}

/** Everything in sight that can be pressed. */
const targets = (page: Page): Promise<Box[]> =>
  page.evaluate(() => {
    const found: Box[] = [];
    const lines: (Element | null)[] = [];
    for (const element of document.querySelectorAll<HTMLElement>('button, a.button, select')) {
      const box = element.getBoundingClientRect();
      const top = document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2);
      const in_sight = top !== null && (element.contains(top) || top.contains(element));
      if (box.width === 0 || !in_sight) continue;
      const { x, y, width, height } = box;
      const what = element.getAttribute('aria-label') ?? element.innerText;
      if (!lines.includes(element.parentElement)) lines.push(element.parentElement);
      const line = lines.indexOf(element.parentElement);
      found.push({ what, line, x, y, width, height });
    }
    return found;
  });

const overlap = (a: Box, b: Box): boolean =>
  a.line === b.line &&
  Math.min(a.x + a.width, b.x + b.width) - Math.max(a.x, b.x) > 0.5 &&
  Math.min(a.y + a.height, b.y + b.height) - Math.max(a.y, b.y) > 0.5;

export const check_layout = async (page: Page): Promise<void> => {
  const { width, height } = page.viewportSize() ?? { width: 0, height: 0 };
  const boxes = await targets(page);
  for (const box of boxes) {
    expect
      .soft(Math.min(box.width, box.height), `size of “${box.what}”`)
      .toBeGreaterThanOrEqual(LEAST_PX);
    expect.soft(box.x + box.width, `right edge of “${box.what}”`).toBeLessThanOrEqual(width);
  }
  const pairs = boxes.flatMap((a, k) => boxes.slice(k + 1).map((b) => [a, b] as const));
  const covered = pairs.filter(([a, b]) => overlap(a, b)).map(([a, b]) => `${a.what} / ${b.what}`);
  expect.soft(covered, 'no two lie over each other').toEqual([]);
  const stop = boxes.find(({ what }) => what === 'Emergency stop');
  expect(stop, 'the stop button is in sight').toBeDefined();
  if (stop) expect(stop.y + stop.height).toBeLessThanOrEqual(height);
  const overflow = await page.evaluate(() => document.documentElement.scrollWidth);
  expect(overflow).toBeLessThanOrEqual(width);
};
