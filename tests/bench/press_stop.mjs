// press_stop.mjs URL: opens the page, and for each line on its input presses the stop's key there.
// Prints when the page saw the key, in milliseconds since 1970, as the browser's clock has it.
import { createRequire } from 'node:module';
import { createInterface } from 'node:readline';

const require = createRequire(new URL('../../web/package.json', import.meta.url));
const { chromium } = require('@playwright/test');

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
  args: ['--no-sandbox', '--disable-gpu', '--disable-background-networking'],
});
const page = await browser.newPage({ viewport: { width: 1440, height: 900 } });
await page.goto(process.argv[2]);
await page.getByRole('group', { name: 'Link' }).getByText('Live').waitFor();
await page.evaluate(() => {
  const seen = (event) => {
    window.pressed_ms = performance.timeOrigin + event.timeStamp;
  };
  window.addEventListener('keydown', seen, { capture: true });
});
console.log('ready');
for await (const line of createInterface({ input: process.stdin })) {
  if (line !== 'press') continue;
  await page.keyboard.press('Escape');
  console.log(await page.evaluate(() => window.pressed_ms));
}
await browser.close();
