// The page as a person uses it: by what is written on it and by where the map is tapped.

import { expect, type Locator, type Page } from '@playwright/test';

export interface Point {
  readonly lat: number;
  readonly lon: number;
}

/** Metres between two near points; good to a per mille. */
export const metres_between = (a: Point, b: Point): number => {
  const north = (b.lat - a.lat) * 111_250;
  const east = (b.lon - a.lon) * 111_320 * Math.cos((a.lat * Math.PI) / 180);
  return Math.hypot(north, east);
};

/** As long as it wants to be held. */
export const press_it = async (button: Locator): Promise<void> => {
  const hold_ms = Number((await button.getAttribute('data-hold')) ?? 0);
  await button.click(hold_ms > 0 ? { delay: hold_ms + 200 } : {});
};

export const press = (page: Page, name: string): Promise<void> =>
  press_it(page.getByRole('button', { name, exact: true }));

export const tab = (page: Page, name: 'Drive' | 'Plan' | 'Missions' | 'Log'): Promise<void> =>
  page.getByRole('navigation', { name: 'Panels' }).getByRole('button', { name }).click();

/** Opens the page and makes anna the first admin, who is then logged in. */
export const make_first_admin = async (
  page: Page,
  station: { readonly url: string; code(): Promise<string> },
  password: string,
): Promise<void> => {
  await page.goto(station.url);
  await page.getByLabel('Code').fill(await station.code());
  await page.getByLabel('User', { exact: true }).fill('anna');
  await page.getByLabel('Password').fill(password);
  await press(page, 'Make the first admin');
  await expect(page.getByRole('group', { name: 'Link' })).toContainText('Live');
};

/** Opens the page and waits until the robot is on the map. */
export const open_page = async (page: Page, url: string): Promise<void> => {
  await page.goto(url);
  await expect(page.getByRole('group', { name: 'Link' })).toContainText('Live');
  await expect(page.getByRole('group', { name: 'Position' })).toHaveAttribute(
    'data-stale',
    'false',
    { timeout: 30_000 },
  );
  // The map and the panels come after the robot's state.
  await expect(page.locator('.scale-bar')).toHaveText(/m$/);
  await expect(page.locator('#panel > *').first()).toBeAttached();
};

/** Where the map is free of panels: its middle, in pixels of the window. */
export const map_middle = async (page: Page): Promise<readonly [number, number]> => {
  const box = async (name: string) => {
    const found = await page.locator(name).boundingBox();
    if (!found) throw new Error(`no ${name} on the page`);
    return found;
  };
  const { width, height } = page.viewportSize() ?? { width: 0, height: 0 };
  const top = await box('header');
  const alerts = await box('.alerts');
  const panel = await box('main');
  const left = width >= 640 ? panel.x + panel.width : 0;
  const bottom = width >= 640 ? height : panel.y;
  const head = Math.max(top.y + top.height, alerts.y + alerts.height);
  return [(left + width) / 2, (head + bottom) / 2];
};

/** Pixels of one metre on the ground, by the scale bar. */
export const pixels_per_m = async (page: Page): Promise<number> => {
  const bar = page.locator('.scale-bar');
  const [, figure = '', unit = ''] = /^([\d.]+) (cm|m|km)$/.exec(await bar.innerText()) ?? [];
  const width = await bar.evaluate((element) => parseFloat(element.style.width));
  return width / (Number(figure) * ({ cm: 0.01, km: 1000 }[unit] ?? 1));
};

export type Pixel = readonly [x: number, y: number];
export type Color = readonly [red: number, green: number, blue: number];

/**
 * Where the map's canvases, one above the other, show one of these colours: pixels of the window.
 * @param off by how much each part of the colour may differ
 */
export const map_pixels = (page: Page, colors: readonly Color[], off = 1): Promise<Pixel[]> =>
  page.evaluate(
    ({ wanted, most }) => {
      const canvas = document.createElement('canvas');
      const context = canvas.getContext('2d', { willReadFrequently: true });
      const found: [number, number][] = [];
      if (!context) return found;
      [canvas.width, canvas.height] = [innerWidth, innerHeight];
      for (const part of document.querySelectorAll<HTMLCanvasElement>('#map canvas')) {
        const { x, y, width, height } = part.getBoundingClientRect();
        if (width > 0) context.drawImage(part, x, y, width, height);
      }
      const { data, width } = context.getImageData(0, 0, canvas.width, canvas.height);
      for (let k = 0; k < data.length; k += 4) {
        const fits = wanted.some((color) =>
          color.every((value, n) => Math.abs((data[k + n] ?? 0) - value) <= most),
        );
        if (fits) found.push([((k / 4) % width) + 0.5, Math.floor(k / 4 / width) + 0.5]);
      }
      return found;
    },
    { wanted: colors, most: off },
  );

/** Where a picture of the whole window shows one of these colours, also where the map is turned. */
export const seen_pixels = async (
  page: Page,
  colors: readonly Color[],
  off = 1,
): Promise<Pixel[]> => {
  const picture = (await page.screenshot({ scale: 'css' })).toString('base64');
  return page.evaluate(
    async ({ wanted, most, base64 }) => {
      const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
      const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
      const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
      const context = canvas.getContext('2d');
      context?.drawImage(bitmap, 0, 0);
      const data = context?.getImageData(0, 0, bitmap.width, bitmap.height).data ?? [];
      const found: [number, number][] = [];
      for (let k = 0; k < data.length; k += 4) {
        const fits = wanted.some((color) =>
          color.every((value, n) => Math.abs((data[k + n] ?? 0) - value) <= most),
        );
        const pixel = k / 4;
        if (fits)
          found.push([(pixel % bitmap.width) + 0.5, Math.floor(pixel / bitmap.width) + 0.5]);
      }
      return found;
    },
    { wanted: colors, most: off, base64: picture },
  );
};

/** How wide and how high those are altogether, pixels. */
export const extent_px = (found: readonly Pixel[]): Pixel => {
  const span = (values: readonly number[]): number =>
    values.length === 0 ? 0 : Math.max(...values) - Math.min(...values);
  return [span(found.map(([x]) => x)), span(found.map(([, y]) => y))];
};

/** Marks a place by a tap, metres right and up of the middle of the map. */
export const mark = async (page: Page, right_m: number, up_m: number): Promise<void> => {
  // An alert that comes or goes moves the middle, and the robot with it.
  let [x, y] = [NaN, NaN];
  await expect(async () => {
    const before = [x, y];
    [x, y] = await map_middle(page);
    expect([x, y]).toEqual(before);
  }).toPass({ intervals: [400] });
  const scale = await pixels_per_m(page);
  await page.mouse.click(x + right_m * scale, y - up_m * scale);
  await expect(page.getByLabel('Chosen place')).toBeVisible();
};

/** Until the map has been drawn as it is now: a tap means what was seen where it fell. */
export const seen_frame = (page: Page): Promise<void> =>
  page.evaluate(
    () =>
      new Promise((done) => {
        requestAnimationFrame(() => {
          requestAnimationFrame(() => {
            done();
          });
        });
      }),
  );

/** Taps the map at places given from the middle of its free part, pixels right and down. */
export const draw = async (
  page: Page,
  places: readonly (readonly [right: number, down: number])[],
): Promise<void> => {
  // A page that was just opened has none yet.
  await page.locator('#map canvas').first().waitFor({ state: 'attached' });
  await seen_frame(page);
  const [x, y] = await map_middle(page);
  for (const [right, down] of places) await page.mouse.click(x + right, y + down);
};

export const items = (page: Page) =>
  page.getByRole('list', { name: 'Items' }).getByRole('listitem');

export const save = async (page: Page): Promise<void> => {
  await press(page, 'Save');
  await expect(page.getByLabel('Summary')).toContainText('saved, revision');
};

/** Arms; the checks want a settled position, and the robot says when it is. */
export const arm = async (page: Page): Promise<void> => {
  await expect(page.getByRole('button', { name: 'Arm', exact: true })).toBeEnabled();
  await expect(async () => {
    const disarm = page.getByRole('button', { name: 'Disarm', exact: true });
    if (!(await disarm.isVisible())) await press(page, 'Arm');
    await expect(disarm).toBeVisible({ timeout: 1000 });
  }).toPass({ timeout: 20_000 });
};

/** From a drawn and saved mission to a driving robot. */
export const drive_it = async (page: Page): Promise<void> => {
  await tab(page, 'Drive');
  await arm(page);
  await page.getByRole('button', { name: /^Load/ }).click();
  await press(page, 'Start…');
  await expect(page.getByRole('dialog')).toContainText('Drives to item');
  await press(page, 'Start driving');
  await expect(page.getByLabel('Mission state')).toHaveText('Running');
};
