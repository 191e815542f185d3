// What the page needs where the robot is not: which requests may be answered by what this device
// kept. Nothing that tells of the robot ever is: an old state must not look like a new one.

/** The page itself; what it is made of; pictures of the ground. */
export type Kept = 'page' | 'part' | 'ground';

export interface Asked {
  readonly method: string;
  readonly url: string;
  /** A person opens a page, as against a page that asks for something. */
  readonly opens: boolean;
}

const GROUND = /^\/api\/v1\/tiles(\/[^/]+\/\d+\/\d+\/\d+)?$/;

/** @param parts paths of the files that the page is made of
 * @return null: the robot alone may answer. */
export const kept_as = (asked: Asked, here: string, parts: readonly string[]): Kept | null => {
  const url = new URL(asked.url);
  if (asked.method !== 'GET' || url.origin !== here) return null;
  if (asked.opens) return url.pathname === '/' || url.pathname === '/index.html' ? 'page' : null;
  if (parts.includes(url.pathname)) return 'part';
  return GROUND.test(url.pathname) ? 'ground' : null;
};

/** The first `wait_ms` belong to the robot; then, or where it cannot be reached, what was kept. With
 * nothing kept it is waited for on.
 * @param kept is asked for only where it is needed */
export const robot_first = async <T>(
  robot: Promise<T>,
  kept: () => Promise<T | undefined>,
  wait_ms: number,
): Promise<T> => {
  let timer: ReturnType<typeof setTimeout> | undefined;
  const late = new Promise<null>((resolve) => {
    timer = setTimeout(() => {
      resolve(null);
    }, wait_ms);
  });
  const first = await Promise.race([robot, late]).catch(() => null);
  clearTimeout(timer);
  return first ?? (await kept()) ?? robot;
};
