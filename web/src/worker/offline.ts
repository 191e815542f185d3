// The service worker: opens the page where the robot is not, so that plans can be made at home. It
// keeps the page's own files and the pictures of the ground that were looked at; all else goes to the
// robot as if there were no worker. The build writes before this file what the page is made of.

import { kept_as, robot_first } from './keeping';

declare const self: ServiceWorkerGlobalScope & {
  readonly page: { readonly version: string; readonly parts: readonly string[] };
};

const PAGE = `page ${self.page.version}`;
const GROUND = 'ground';
/** About 60 MB of pictures; the oldest go. */
const MOST_PICTURES = 3000;
const LOOK_AFTER = 100;
/** So long the robot has the first word. */
const OPENING_MS = 4000;
const PICTURE_MS = 8000;

const keep_page = async (): Promise<void> => {
  const cache = await caches.open(PAGE);
  await cache.add(new Request('/', { cache: 'no-cache' }));
  await cache.addAll([...self.page.parts]);
};

const forget_older = async (): Promise<void> => {
  for (const name of await caches.keys()) {
    if (name !== PAGE && name !== GROUND) await caches.delete(name);
  }
};

let pictures = 0;
const keep_picture = async (request: Request, response: Response): Promise<void> => {
  const cache = await caches.open(GROUND);
  await cache.put(request, response);
  pictures += 1;
  if (pictures % LOOK_AFTER !== 0) return;
  const all = await cache.keys();
  for (const old of all.slice(0, Math.max(0, all.length - MOST_PICTURES))) await cache.delete(old);
};

const picture = async (event: FetchEvent): Promise<Response> => {
  const robot = fetch(event.request).then((response) => {
    if (response.status === 200) {
      // A full disk is no reason to show nothing.
      const keeping = keep_picture(event.request, response.clone()).catch(() => undefined);
      event.waitUntil(keeping);
    }
    return response;
  });
  return robot_first(robot, () => caches.match(event.request), PICTURE_MS);
};

const opened = async (request: Request): Promise<Response> =>
  robot_first(fetch(request), () => caches.match('/', { cacheName: PAGE }), OPENING_MS);

const part = async (request: Request): Promise<Response> =>
  (await caches.match(request.url, { cacheName: PAGE, ignoreVary: true })) ?? fetch(request);

self.addEventListener('install', (event) => {
  event.waitUntil(keep_page().then(() => self.skipWaiting()));
});
self.addEventListener('activate', (event) => {
  event.waitUntil(forget_older().then(() => self.clients.claim()));
});
self.addEventListener('fetch', (event) => {
  const { method, url, mode } = event.request;
  const asked = { method, url, opens: mode === 'navigate' };
  const kept = kept_as(asked, self.location.origin, self.page.parts);
  if (kept === 'page') event.respondWith(opened(event.request));
  if (kept === 'part') event.respondWith(part(event.request));
  if (kept === 'ground') event.respondWith(picture(event));
});
