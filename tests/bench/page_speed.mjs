// Measures the page in Chromium against the real roverd and simulator, and prints a table.
//
//   tests/bench/page_speed.mjs [--only load,drive,drag,stale,pad,heap] [--items 5000] [--slower 4]
//                              [--heap-minutes 1] [--dist DIR] [--profile FILE] [--parts]
//
// --dist takes the page from a folder (web/dist) instead of the program, for all but "load"; --profile
// writes where the time went while driving, for Chromium's developer tools, --parts prints it. ROVERD_BIN, CHROMIUM: the
// programs. Shares of the main thread are its own CPU time, slowed: what other programs do on the
// machine counts little. Frames, latencies and paints are by the clock on the wall, and do suffer.

import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { connect } from 'node:net';
import { setPriority, tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { createInterface } from 'node:readline';
import { parseArgs } from 'node:util';

const ROOT = resolve(import.meta.dirname ?? new URL('.', import.meta.url).pathname, '../..');
const require = createRequire(join(ROOT, 'web/package.json'));
const { chromium } = require('@playwright/test');
const BIN = process.env.ROVERD_BIN ?? join(ROOT, 'build/bin');

const { values: options } = parseArgs({
  options: {
    only: { type: 'string', default: 'load,drive,drag,stale,pad,heap' },
    items: { type: 'string', default: '5000' },
    slower: { type: 'string', default: '4' },
    'heap-minutes': { type: 'string', default: '1' },
    dist: { type: 'string' },
    profile: { type: 'string' },
    parts: { type: 'boolean' },
  },
});
const ITEMS = Number(options.items);
const SLOWER = Number(options.slower);
const LAPTOP = { width: 1440, height: 900 };
const PHONE = { width: 390, height: 844 };

const wait = (ms) => new Promise((done) => setTimeout(done, ms));
const median = (values) => values.toSorted((a, b) => a - b)[Math.floor(values.length / 2)];
const until = async (what, test, limit_ms = 60_000) => {
  const end = Date.now() + limit_ms;
  for (;;) {
    const value = await test();
    if (value) return value;
    if (Date.now() > end) throw new Error(`never came: ${what}`);
    await wait(100);
  }
};
const rows = [];
const figure = (name, value, promise = '') => {
  rows.push(`| ${name} | ${value} | ${promise} |`);
  console.error(`${name}: ${value}`);
};

// --- the robot

const ended = [];
const start = (name, args, ready) =>
  new Promise((done, failed) => {
    const child = spawn(join(BIN, name), args, { stdio: ['ignore', 'pipe', 'pipe'] });
    // The robot's own computer does not also run a browser at a fraction of its speed.
    try {
      setPriority(child.pid, -12);
    } catch {
      console.error('no right to put the robot before the browser: on a busy machine it may pause');
    }
    ended.push(() => child.kill('SIGCONT') && child.kill('SIGKILL'));
    const lines = [];
    const read = (line) => {
      lines.push(line);
      const match = ready.exec(line);
      if (match) done({ child, match });
    };
    for (const stream of [child.stdout, child.stderr]) createInterface({ input: stream }).on('line', read);
    child.on('exit', () => failed(new Error(`${name} ended: ${lines.slice(-5).join(' | ')}`)));
  });

const begin_robot = async (folder) => {
  const bus = ['--cansock', join(folder, 'can'), '--gnss', 'tcp:0', '--control', '0', '--seed', '7'];
  const sim = await start('roverd-sim', bus, /^ready can=(\S+) gnss=(\S+) mti=(\S+).* control=(\S+)/);
  const [, can, gnss, mti, control] = sim.match;
  const links = { 'drivers.bunker.link': can, 'drivers.gnss.link': gnss, 'drivers.mti.link': mti };
  const roverd = await start(
    'roverd',
    [
      ...['--config', join(ROOT, 'config/robot.toml'), '--data', join(folder, 'data'), '--port', '0'],
      ...Object.entries(links).flatMap(([name, link]) => ['--set', `${name}=${link}`]),
    ],
    /^listening on (https?:\S+)/,
  );
  const [host, port] = control.split(':');
  const truth = { now: null, track: [] };
  const side = connect({ host, port: Number(port) });
  createInterface({ input: side }).on('line', (text) => {
    const line = JSON.parse(text);
    if (typeof line.lat !== 'number') return;
    truth.now = line;
    truth.track.push({ ...line, at_ms: Date.now() });
    if (truth.track.length > 2000) truth.track.splice(0, 1000);
  });
  side.write(`${JSON.stringify({ set: { truth_hz: 50 } })}\n`);
  ended.push(() => side.destroy());
  const url = roverd.match[1];
  const rest = async (method, path, body) => {
    const answer = await fetch(`${url}/api/v1${path}`, {
      method,
      headers: { 'Content-Type': 'application/json' },
      ...(body === undefined ? {} : { body: JSON.stringify(body) }),
    });
    const text = await answer.text();
    if (!answer.ok) throw new Error(`${method} ${path} answers ${answer.status}: ${text.slice(0, 300)}`);
    return text === '' ? null : JSON.parse(text);
  };
  await until('the robot knows where it is', () => truth.now);
  return { url, rest, truth, child: roverd.child };
};

/** Up and down beside the robot, 2 m from point to point. */
const field = ({ lat, lon }) => {
  const rows_of = 50;
  const east_m = 1 / (111_320 * Math.cos((lat * Math.PI) / 180));
  return Array.from({ length: ITEMS }, (_, k) => {
    const column = Math.floor(k / rows_of);
    const row = column % 2 === 0 ? k % rows_of : rows_of - 1 - (k % rows_of);
    return {
      type: 'waypoint',
      lat: lat + (4 + 2 * row) / 111_250,
      lon: lon + (column * 2 + 0.3 * Math.sin(row)) * east_m,
    };
  });
};

const drive_mission = async (robot) => {
  const items = field(robot.truth.now);
  const mission = await robot.rest('POST', '/missions', { name: `${ITEMS} items`, items });
  await until('arm', () => robot.rest('POST', '/vehicle/arm').then(() => true, () => false));
  await robot.rest('POST', '/execution/load', { mission_id: mission.id });
  await robot.rest('POST', '/execution/start', { mission_id: mission.id, revision: mission.revision });
  await until('it drives', () => Math.abs(robot.truth.now.speed_mps) > 0.3);
  return mission;
};

// --- the page

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
  args: ['--no-sandbox', '--disable-gpu', '--disable-background-networking', '--enable-precise-memory-info', '--disable-features=LocalNetworkAccessChecks'],
});

const WATCH = () => {
  // Runs in the page before everything else.
  const seen = { live_ms: null, longest_ms: 0, moved: 0, frames: 0 };
  window.seen = seen;
  new PerformanceObserver((list) => {
    for (const { duration } of list.getEntries()) {
      seen.longest_ms = Math.max(seen.longest_ms, duration);
    }
  }).observe({ type: 'longtask', buffered: true });
  let fresh = false;
  window.addEventListener('pointermove', () => (fresh = true), { capture: true, passive: true });
  const link = () => document.querySelector('[aria-label="Link"]');
  const frame = () => {
    if (window.counting) {
      seen.frames += 1;
      if (fresh) seen.moved += 1;
    }
    fresh = false;
    requestAnimationFrame(frame);
  };
  if (window.name !== 'no frames') window.begin_frames = () => requestAnimationFrame(frame);
  new MutationObserver(() => {
    const cell = link();
    if (seen.live_ms === null && cell?.textContent.includes('Live')) seen.live_ms = performance.now();
    if (cell && window.watch_stale) {
      if (cell.dataset.stale === 'true' || /Silent|Late|Offline/.test(cell.textContent)) {
        seen.stale_at ??= performance.timeOrigin + performance.now();
      }
    }
  }).observe(document, { subtree: true, childList: true, characterData: true, attributes: true });
};

const open = async (robot, viewport, slower, network = null) => {
  const context = await browser.newContext({ viewport, serviceWorkers: 'block' });
  const page = await context.newPage();
  const cdp = await context.newCDPSession(page);
  await page.addInitScript(WATCH);
  const load = { bytes: 0 };
  await cdp.send('Network.enable');
  cdp.on('Network.loadingFinished', ({ encodedDataLength }) => (load.bytes += encodedDataLength));
  if (network) await cdp.send('Network.emulateNetworkConditions', { offline: false, ...network });
  await cdp.send('Performance.enable', { timeDomain: 'threadTicks' });
  if (slower > 1) await cdp.send('Emulation.setCPUThrottlingRate', { rate: slower });
  if (options.dist) {
    await page.route(/^[^?]*\/(assets\/.*|icon.svg)?$/, (route) => {
      const path = new URL(route.request().url()).pathname;
      return route.fulfill({ path: join(options.dist, path === '/' ? 'index.html' : path) });
    });
  }
  await page.goto(robot.url);
  await until('live', () => page.evaluate(() => window.seen.live_ms));
  return { page, cdp, load, close: () => context.close() };
};

const metrics = async (cdp) => {
  const { metrics: list } = await cdp.send('Performance.getMetrics');
  return Object.fromEntries(list.map(({ name, value }) => [name, value]));
};

/** The tasks of the page's main thread while something goes on: CPU time, milliseconds. */
const traced = async ({ page }, work) => {
  await browser.startTracing(page, { categories: ['toplevel', 'devtools.timeline', '__metadata', ...(options.parts ? ['cc', 'blink', 'viz', 'gpu'] : [])] });
  const from = Date.now();
  const result = await work();
  const seconds = (Date.now() - from) / 1000;
  const { traceEvents } = JSON.parse((await browser.stopTracing()).toString());
  const mains = traceEvents.filter(({ name, args }) => name === 'thread_name' && args.name === 'CrRendererMain');
  const busiest = mains
    .map(({ pid, tid }) => traceEvents.filter((each) => each.pid === pid && each.tid === tid && each.tdur > 0))
    .toSorted((a, b) => b.length - a.length)[0];
  const tasks = busiest.filter(({ name }) => name === 'ThreadControllerImpl::RunTask' || name === 'RunTask');
  const cpu_ms = tasks.map(({ tdur }) => tdur / 1000);
  if (options.parts) {
    const parts = {};
    for (const { name, tdur } of busiest) parts[name] = (parts[name] ?? 0) + tdur / 1000 / seconds;
    console.error(Object.entries(parts).toSorted((a, b) => b[1] - a[1]).slice(0, 24));
    const pictures = busiest.filter(({ name }) => name === 'ProxyMain::BeginMainFrame').length;
    const all_ms = cpu_ms.reduce((sum, ms) => sum + ms, 0);
    console.error(`${pictures} pictures, ${(all_ms / pictures).toFixed(2)} ms CPU time for each`);
    console.error('largest tasks, ms', cpu_ms.toSorted((a, b) => b - a).slice(0, 8).map(Math.round));
  }
  return {
    result,
    seconds,
    share: cpu_ms.reduce((sum, ms) => sum + ms, 0) / 1000 / seconds,
    longest_ms: Math.max(0, ...cpu_ms),
    long: cpu_ms.filter((ms) => ms > 50).length,
  };
};

/** Whatever paused it: it drives while it is measured. */
const keep_driving = async (robot) => {
  for (let k = 0; k < 20 && Math.abs(robot.truth.now.speed_mps) < 0.2; k += 1) {
    await robot.rest('POST', '/execution/resume').catch(() => undefined);
    await wait(1500);
  }
  if (Math.abs(robot.truth.now.speed_mps) < 0.2) console.error('it does not drive');
};

/** Over some seconds. */
const busy = async (view, seconds) => {
  await view.page.evaluate(() => Object.assign(window.seen, { longest_ms: 0 }));
  const tasks = await traced(view, () => wait(seconds * 1000));
  return { ...tasks, wall_ms: await view.page.evaluate(() => window.seen.longest_ms) };
};
const percent = (share) => `${(100 * share).toFixed(0)} %`;
const longest = ({ longest_ms, long, wall_ms }) =>
  `${longest_ms.toFixed(0)} ms (${long} over 50 ms; by the wall's clock ${wall_ms < 50 ? 'under 50' : wall_ms.toFixed(0)} ms)`;
const press = (page, name) => page.getByRole('button', { name, exact: true }).click();
const tab = (page, name) =>
  page.getByRole('navigation', { name: 'Panels' }).getByRole('button', { name }).click();

const measure_load = async (robot) => {
  const network = { latency: 20, downloadThroughput: 1.25e6, uploadThroughput: 1.25e6 };
  for (const [name, viewport] of [['phone', PHONE], ['laptop', LAPTOP]]) {
    const paints = [];
    const lives = [];
    for (let run = 0; run < 5; run += 1) {
      const view = await open(robot, viewport, SLOWER, network);
      await wait(1000);
      const paint = await view.page.evaluate(
        () => performance.getEntriesByName('first-contentful-paint')[0]?.startTime ?? NaN,
      );
      paints.push(paint);
      lives.push(await view.page.evaluate(() => window.seen.live_ms));
      if (run === 0) figure(`first load, compressed, ${name}`, `${(view.load.bytes / 1000).toFixed(0)} kB`, '300 kB');
      await view.close();
    }
    figure(
      `first paint, CPU ${SLOWER} times slower, 10 Mbit/s, ${name}, median of 5 (worst)`,
      `${(median(paints) / 1000).toFixed(2)} s (${(Math.max(...paints) / 1000).toFixed(2)})`,
      '1.0 s',
    );
    figure(
      `live, the same`,
      `${(median(lives) / 1000).toFixed(2)} s (${(Math.max(...lives) / 1000).toFixed(2)})`,
      '2.0 s',
    );
  }
};

const profiled = async ({ cdp }, work, name) => {
  if (!options.profile) return work();
  await cdp.send('Profiler.enable');
  await cdp.send('Profiler.setSamplingInterval', { interval: 500 });
  await cdp.send('Profiler.start');
  const result = await work();
  const { profile } = await cdp.send('Profiler.stop');
  writeFileSync(`${options.profile}.${name}.cpuprofile`, JSON.stringify(profile));
  return result;
};

const measure_drive = async (robot) => {
  for (const [name, viewport] of [['laptop', LAPTOP], ['phone', PHONE]]) {
    const view = await open(robot, viewport, SLOWER);
    await wait(3000);
    await keep_driving(robot);
    const close = await profiled(view, () => busy(view, 15), 'drive');
    figure(`main thread, ${ITEMS} items driven at 10 Hz, CPU ${SLOWER} times slower, ${name}`, percent(close.share), '25 %');
    figure('longest task, the same', longest(close), '100 ms');
    await press(view.page, 'Show the whole mission');
    await wait(2000);
    await keep_driving(robot);
    const far = await busy(view, 15);
    figure(`the same with the whole route in sight, ${name}`, percent(far.share), '25 %');
    figure('longest task, the same', longest(far), '100 ms');
    await view.close();
  }
};

const over_point = (page) => page.locator('#map').evaluate((map) => map.style.cursor === 'pointer');

const measure_drag = async (robot) => {
  const view = await open(robot, LAPTOP, 1);
  const { page, cdp } = view;
  await tab(page, 'Missions');
  await page.getByRole('list', { name: 'Stored missions' }).locator('button.open').first().click();
  await tab(page, 'Plan');
  await page.getByRole('list', { name: 'Items' }).waitFor();
  await press(page, 'Show the whole mission');
  await wait(1000);
  // A point, by the mouse's shape over it.
  let place = null;
  for (let k = 0; k < 400 && !place; k += 1) {
    const [x, y] = [900 + (k % 20) * 7, 350 + Math.floor(k / 20) * 9];
    await page.mouse.move(x, y);
    await wait(30);
    if (await over_point(page)) place = [x, y];
  }
  if (!place) throw new Error('no point found to drag');
  await cdp.send('Emulation.setCPUThrottlingRate', { rate: SLOWER });
  await wait(1000);
  await page.evaluate(() => window.begin_frames());
  const mouse = (type, x, y, buttons) =>
    cdp.send('Input.dispatchMouseEvent', { type, x, y, button: 'left', buttons, clickCount: 1 });
  await mouse('mousePressed', ...place, 1);
  await mouse('mouseMoved', place[0] + 5, place[1] + 5, 1);
  await mouse('mouseMoved', place[0] + 10, place[1] + 10, 1);
  await page.evaluate(() => {
    Object.assign(window.seen, { longest_ms: 0, frames: 0, moved: 0 });
    window.counting = true;
  });
  const moves = [];
  const drag = await profiled(view, () => traced(view, async () => {
    const from = Date.now();
    for (let step = 1; Date.now() - from < 6000; step += 1) {
      const [x, y] = [place[0] + 80 * Math.sin(step / 20), place[1] + 60 * Math.cos(step / 20)];
      moves.push(mouse('mouseMoved', x, y, 1));
      await wait(16);
    }
    return page.evaluate(() => {
      window.counting = false;
      return { ...window.seen };
    });
  }), 'drag');
  const { seconds } = drag;
  const { moved, frames, longest_ms: wall_ms } = drag.result;
  await Promise.all(moves);
  const drop = async () => {
    await mouse('mouseReleased', ...place, 0);
    await wait(2000);
  };
  const dropped = await profiled(view, () => traced(view, drop), 'drop');
  figure(`dragging a waypoint of ${ITEMS}, all in sight, CPU ${SLOWER} times slower, frames with a new place`, `${(moved / seconds).toFixed(0)} /s`, '30 /s');
  figure('all frames, the same', `${(frames / seconds).toFixed(0)} /s`);
  figure('main thread, the same', percent(drag.share));
  figure('longest task, the same', longest({ ...drag, wall_ms }), '100 ms');
  figure('longest task at the end of the drag', `${dropped.longest_ms.toFixed(0)} ms`, '100 ms');
  await view.close();
};

const measure_stale = async (robot) => {
  for (const slower of [1, SLOWER]) {
    const view = await open(robot, LAPTOP, slower);
    await wait(3000);
    const ages = [];
    for (let run = 0; run < 5; run += 1) {
      await view.page.evaluate(() => {
        delete window.seen.stale_at;
        window.watch_stale = true;
      });
      await wait(137 * run);
      const lost_ms = Date.now();
      robot.child.kill('SIGSTOP');
      await wait(2600);
      const { stale_at } = await view.page.evaluate(() => ({ ...window.seen }));
      robot.child.kill('SIGCONT');
      ages.push((stale_at ?? Infinity) - lost_ms);
      await view.page.evaluate(() => (window.watch_stale = false));
      await wait(4000);
    }
    const text = `${(median(ages) / 1000).toFixed(2)} s (${(Math.max(...ages) / 1000).toFixed(2)})`;
    figure(`data stale on the screen after SIGSTOP, CPU ${slower} times slower, median of 5 (worst)`, text, '1.0 s');
    await view.close();
  }
};

const measure_pad = async (robot) => {
  await robot.rest('POST', '/execution/stop').catch(() => undefined);
  await until('arm', () => robot.rest('POST', '/vehicle/arm').then(() => true, () => false));
  const view = await open(robot, LAPTOP, 1);
  const { page } = view;
  await page.getByRole('group', { name: 'Change the mode' }).getByRole('button', { name: 'MANUAL' }).click();
  const pad = page.getByRole('application', { name: /^Drive pad/ });
  await pad.scrollIntoViewIfNeeded();
  await page.evaluate(() => {
    window.addEventListener('pointerup', (event) => (window.let_go = performance.timeOrigin + event.timeStamp), {
      capture: true,
    });
  });
  const [still, slow, speeds] = [[], [], []];
  for (let run = 0; run < 5; run += 1) {
    const box = await pad.boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x, y - 0.49 * box.height, { steps: 3 });
    await wait(3000);
    const speed = robot.truth.now.speed_mps;
    robot.truth.track.length = 0;
    await page.mouse.up();
    await wait(2000);
    const let_go = await page.evaluate(() => window.let_go);
    const first = (fits) => (robot.truth.track.find(fits)?.at_ms ?? Infinity) - let_go;
    slow.push(first((line) => Math.abs(line.speed_mps) < 0.95 * Math.abs(speed)));
    still.push(first((line) => Math.abs(line.speed_mps) < 0.02));
    speeds.push(speed);
  }
  const seconds = (values) => `${(median(values) / 1000).toFixed(2)} s (${(Math.max(...values) / 1000).toFixed(2)})`;
  figure(`pad released to robot still, from ${median(speeds).toFixed(2)} m/s, median of 5 (worst)`, seconds(still), '0.4 s');
  figure('of that, until it begins to slow down', seconds(slow));
  await view.close();
};

const measure_heap = async (robot) => {
  const minutes = Number(options['heap-minutes']);
  const view = await open(robot, LAPTOP, 1);
  await wait(5000);
  const heap = async () => {
    await view.cdp.send('HeapProfiler.collectGarbage');
    const { JSHeapUsedSize, Nodes, JSEventListeners } = await metrics(view.cdp);
    return { mb: JSHeapUsedSize / 1e6, nodes: Nodes, listeners: JSEventListeners };
  };
  const seen = [await heap()];
  const steps = Math.max(4, Math.round(minutes * 2));
  for (let k = 0; k < steps; k += 1) {
    await wait((minutes * 60_000) / steps);
    await keep_driving(robot);
    seen.push(await heap());
  }
  const [first, last] = [seen[1], seen.at(-1)];
  const text = `${first.mb.toFixed(1)} to ${last.mb.toFixed(1)} MB, ${first.nodes} to ${last.nodes} nodes`;
  figure(`heap while driving, first to last of ${minutes} min`, text, 'flat');
  await view.close();
};

const folder = mkdtempSync(join(tmpdir(), 'roverd-speed.'));
try {
  const robot = await begin_robot(folder);
  console.error(`roverd at ${robot.url}`);
  const wanted = options.only.split(',');
  if (wanted.includes('load')) await measure_load(robot);
  if (wanted.some((what) => ['drive', 'drag', 'heap', 'stale'].includes(what))) await drive_mission(robot);
  if (wanted.includes('drive')) await measure_drive(robot);
  if (wanted.includes('drag')) await measure_drag(robot);
  if (wanted.includes('heap')) await measure_heap(robot);
  if (wanted.includes('stale')) await measure_stale(robot);
  if (wanted.includes('pad')) await measure_pad(robot);
  console.log(['| figure | measured | promised |', '|---|---|---|', ...rows].join('\n'));
} finally {
  await browser.close();
  for (const end of ended) end();
  rmSync(folder, { recursive: true, force: true });
}
