// The page over TLS, in a browser that trusts the robot's authority as a person makes it trust it: in
// the store of certificates of that user, who owns nothing else.

import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import { chromium, type Browser } from '@playwright/test';

import { expect, test } from './station';

test.use({ more: ['--tls'] });

/** A browser of a user who has installed this certificate; of one who trusts nobody without. */
const browser_of = async (home: string, certificate?: string): Promise<Browser> => {
  const store = join(home, '.pki/nssdb');
  mkdirSync(store, { recursive: true });
  const certutil = (...words: string[]) =>
    execFileSync('certutil', ['-d', `sql:${store}`, ...words], { stdio: 'pipe' });
  certutil('-N', '--empty-password');
  if (certificate) certutil('-A', '-n', 'robot', '-t', 'C,,', '-i', certificate);
  const { launchOptions } = test.info().project.use;
  return chromium.launch({ ...launchOptions, env: { ...process.env, HOME: home } });
};

test('a browser that trusts the authority has a secure page with a living stream', async ({
  station,
}) => {
  const home = mkdtempSync(join(tmpdir(), 'roverd-home.'));
  let browser: Browser | undefined;
  try {
    // Given the certificate as the pairing page hands it out, in the open,
    const open = station.url.replace('https:', 'http:');
    const answer = await fetch(`${open}/ca.crt`);
    const certificate = join(home, 'roverd-ca.crt');
    writeFileSync(certificate, Buffer.from(await answer.arrayBuffer()));
    browser = await browser_of(home, certificate);
    const page = await browser.newPage();

    // when the pairing page leads to the robot,
    await page.goto(`${open}/pair`);
    await expect(page.getByRole('heading', { level: 1 })).toContainText('Pair with');
    await expect(page.getByRole('img', { name: 'QR code' })).toBeVisible();
    expect(await page.evaluate(() => document.querySelector('img')?.naturalWidth)).toBeGreaterThan(
      0,
    );
    await page.getByRole('link', { name: station.url, exact: true }).click();

    // then the page is secure, and its stream works.
    await expect(page).toHaveURL(`${station.url}/`);
    await expect(page.getByRole('group', { name: 'Link' })).toContainText('Live');
    expect(await page.evaluate(() => window.isSecureContext)).toBe(true);
    expect(await page.evaluate(() => 'wakeLock' in navigator)).toBe(true);
    await expect(page.getByRole('group', { name: 'Position' })).toHaveAttribute(
      'data-stale',
      'false',
      { timeout: 30_000 },
    );
    // And http leads there, too.
    await page.goto(`${open}/`);
    await expect(page).toHaveURL(`${station.url}/`);
  } finally {
    await browser?.close();
    rmSync(home, { recursive: true, force: true });
  }
});

test('a browser that does not trust the authority shows no page', async ({ station }) => {
  const home = mkdtempSync(join(tmpdir(), 'roverd-home.'));
  let browser: Browser | undefined;
  try {
    browser = await browser_of(home);
    const page = await browser.newPage();
    await expect(page.goto(`${station.url}/`)).rejects.toThrow(/ERR_CERT_AUTHORITY_INVALID/);
  } finally {
    await browser?.close();
    rmSync(home, { recursive: true, force: true });
  }
});
