// What axe finds on a page as it is, and on the same page in the sun.

import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

import type { AxeResults, RunOptions } from 'axe-core';
import type { Page } from '@playwright/test';

const SOURCE = readFileSync(
  createRequire(`${process.cwd()}/package.json`).resolve('axe-core/axe.min.js'),
  'utf8',
);

interface Axe {
  readonly run: (options: RunOptions) => Promise<AxeResults>;
}

const run = async (page: Page, where: string, options: RunOptions): Promise<string[]> => {
  if (!(await page.evaluate(() => 'axe' in window))) await page.evaluate(SOURCE);
  const { violations } = await page.evaluate(
    (given) => (window as unknown as { axe: Axe }).axe.run(given),
    options,
  );
  return violations.flatMap(({ id, nodes }) =>
    nodes.map(
      ({ html, failureSummary }) =>
        `${where}: ${id}: ${html.slice(0, 160)} ${failureSummary ?? ''}`,
    ),
  );
};

/** Sentences that name the view, the rule and the element; none: nothing was found. */
export const faults = (page: Page, where: string): Promise<string[]> => run(page, where, {});

/** Of colours alone: nothing else is another one there. */
const faults_of_colours = (page: Page, where: string): Promise<string[]> =>
  run(page, where, { runOnly: ['color-contrast'] });

/** The page is afterwards light. */
export const faults_in_the_dark = async (page: Page, where: string): Promise<string[]> => {
  await page.emulateMedia({ colorScheme: 'dark' });
  const found = await faults_of_colours(page, `${where}, dark`);
  await page.emulateMedia({ colorScheme: 'light' });
  return found;
};

/** The look is afterwards as it was. */
export const faults_in_sunlight = async (page: Page, where: string): Promise<string[]> => {
  const wear = (look: string | null): Promise<string | null> =>
    page.evaluate((next) => {
      const { dataset } = document.documentElement;
      const before = dataset['look'] ?? null;
      if (next === null) delete dataset['look'];
      else dataset['look'] = next;
      return before;
    }, look);
  const before = await wear('sunlight');
  const found = await faults_of_colours(page, `${where}, sunlight`);
  await wear(before);
  return found;
};
