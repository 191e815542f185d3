// The camera beside the map: its picture, how old it is, and what is said when it hangs.

import { createServer, type Server, type ServerResponse } from 'node:http';
import type { AddressInfo } from 'node:net';

import type { Page } from '@playwright/test';

import { map_middle, open_page } from './page';
import { expect, test as base } from './station';

/** An IP camera: ten pictures a second, or the last one again and again. */
class FakeCamera {
  hangs = false;
  #pictures: readonly Buffer[] = [];
  #shown = 0;
  readonly #clients = new Set<ServerResponse>();
  readonly #server: Server;
  readonly #timer = setInterval(() => this.#show(), 100);

  constructor() {
    this.#server = createServer((_, response) => {
      response.writeHead(200, {
        'Content-Type': 'multipart/x-mixed-replace; boundary=picture',
      });
      this.#clients.add(response);
      response.on('close', () => this.#clients.delete(response));
    });
  }
  async open(): Promise<string> {
    await new Promise<void>((done) => this.#server.listen(0, '127.0.0.1', done));
    return `http://127.0.0.1:${(this.#server.address() as AddressInfo).port}/video`;
  }
  takes(pictures: readonly Buffer[]): void {
    this.#pictures = pictures;
  }
  close(): void {
    clearInterval(this.#timer);
    this.#server.closeAllConnections();
    this.#server.close();
  }
  #show(): void {
    if (!this.hangs) this.#shown += 1;
    const picture = this.#pictures[this.#shown % this.#pictures.length];
    if (!picture) return;
    const head = `--picture\r\nContent-Type: image/jpeg\r\nContent-Length: ${picture.length}\r\n\r\n`;
    for (const client of this.#clients) client.write(Buffer.concat([Buffer.from(head), picture]));
  }
}

const test = base.extend<{ camera: FakeCamera }>({
  // eslint-disable-next-line no-empty-pattern
  camera: async ({}, use) => {
    const camera = new FakeCamera();
    await use(camera);
    camera.close();
  },
  more: async ({ camera }, use) => {
    await use(['--set', `cameras.front.link=${await camera.open()}`]);
  },
});

/** Real JPEG pictures, by the browser. */
const pictures = async (page: Page): Promise<readonly Buffer[]> => {
  const out: Buffer[] = [];
  for (const colour of ['teal', 'olive', 'navy']) {
    await page.setContent(`<body style="background:${colour}">`);
    const clip = { x: 0, y: 0, width: 160, height: 120 };
    out.push(await page.screenshot({ type: 'jpeg', clip }));
  }
  return out;
};

test('its age stands on the picture, and a camera that hangs is told as frozen', async ({
  page,
  station,
  camera,
}) => {
  camera.takes(await pictures(page));
  await open_page(page, station.url);
  const view = page.getByRole('region', { name: 'Camera' });
  const picture = view.getByRole('img', { name: 'What the camera front sees' });
  await expect(view).toContainText(/^\s*Camera\s*0\.\d s/, { timeout: 15_000 });
  // Whole, or smaller where the link or this machine is slow.
  const width = (): Promise<number> =>
    picture.evaluate((img: HTMLImageElement) => img.naturalWidth);
  await expect.poll(async () => [160, 80, 40, 20].includes(await width())).toBe(true);

  // On a phone it leaves the robot in sight, which is in the middle of the map.
  await page.setViewportSize({ width: 390, height: 844 });
  const box = await view.boundingBox();
  const [middle] = await map_middle(page);
  expect(middle - (box ? box.x + box.width : Infinity)).toBeGreaterThan(18);

  camera.hangs = true; // and sends on
  await expect(view).toContainText(/Frozen [2-9]\.\d s/);
  await expect(picture).toBeVisible();
  camera.hangs = false;
  await expect(view).toContainText(/^\s*Camera\s*0\.\d s/);

  await view.getByRole('button', { name: 'Camera' }).click();
  await expect(picture).toBeHidden();
  await page.reload();
  await expect(view.getByRole('button', { name: 'Camera' })).toHaveAttribute(
    'aria-pressed',
    'false',
  );
});
