// The page's tests: real browsers, the real roverd and the simulated robot. They drive in real time
// and mostly wait for it, each with a robot of its own: two of them share two cores well.

import { availableParallelism } from 'node:os';

import { defineConfig } from '@playwright/test';

export default defineConfig({
  testDir: '../tests/page',
  outputDir: '../tests/page/results',
  workers: Math.max(2, Math.floor(availableParallelism() / 2)),
  fullyParallel: true,
  // On a busy machine a browser may be late once. What fails twice fails; a second try is told.
  retries: 1,
  timeout: 90_000,
  expect: { timeout: 15_000 },
  forbidOnly: process.env['CI'] === 'true',
  reporter: 'list',
  use: {
    // The device's own browser; none is ever downloaded.
    launchOptions: {
      executablePath: process.env['CHROMIUM'] ?? '/usr/bin/chromium',
      args: [
        '--no-sandbox',
        '--disable-gpu',
        '--disable-background-networking',
        '--disable-component-update',
        '--disable-sync',
        '--no-first-run',
      ],
    },
    viewport: { width: 1440, height: 900 },
    // What a test takes from the robot must come from the robot.
    serviceWorkers: 'block',
    locale: 'en-GB',
    timezoneId: 'UTC',
    trace: 'on-first-retry', // each one costs time of the processor
  },
});
