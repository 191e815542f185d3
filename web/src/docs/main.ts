// /docs: the interface for people, out of the OpenAPI document that this very server answers with.
// Reading only: nothing on this page can move the robot.

import 'openapi-explorer/dist/browser/openapi-explorer.min.js';
import './docs.css';

import { type Document, with_curl } from '../model/curl';

interface Explorer extends HTMLElement {
  loadSpec(document: Document): void;
}
interface Refusal {
  slug: string;
  status: number;
  title: string;
  meaning: string;
}

const element = (name: string, text: string): HTMLElement => {
  const made = document.createElement(name);
  made.textContent = text;
  return made;
};

/** What the `type` of a refusal leads to: "#problem-conflict". */
const refusals = (list: Refusal[]): HTMLElement => {
  const box = document.createElement('section');
  box.slot = 'overview-footer';
  const rows = list.map((refusal) => {
    const row = document.createElement('tr');
    row.id = `problem-${refusal.slug}`;
    if (location.hash === `#${row.id}`) row.className = 'meant';
    row.append(
      element('td', String(refusal.status)),
      element('td', refusal.title),
      element('td', refusal.meaning),
    );
    return row;
  });
  const table = document.createElement('table');
  table.append(...rows);
  box.append(element('h2', 'Refusals'), table);
  return box;
};

const explorer = document.createElement('openapi-explorer') as Explorer;
for (const [name, value] of Object.entries({
  'hide-console': '', // no button that sends: a page to read must not drive
  'hide-authentication': '',
  'hide-server-selection': '',
  'use-path-in-nav-bar': '',
  'nav-bg-color': '#1d2733',
  'nav-hover-bg-color': '#0f1720',
  'header-color': '#1d2733',
  'primary-color': '#2563eb',
}))
  explorer.setAttribute(name, value);
document.body.append(explorer);

const show = async (): Promise<void> => {
  const answer = await fetch('/openapi.json');
  if (!answer.ok) throw new Error(`the server answered ${answer.status}`);
  const api = (await answer.json()) as Document;
  const meant = location.hash.startsWith('#problem-');
  explorer.append(refusals((api['x-problems'] ?? []) as Refusal[]));
  explorer.loadSpec(with_curl(api, location.origin));
  if (meant) document.querySelector('.meant')?.scrollIntoView();
};

show().catch((error: unknown) => {
  document.body.prepend(element('p', `The interface could not be read: ${String(error)}`));
});
