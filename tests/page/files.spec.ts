// Files from the field: missions of other ground stations, and a recorded receiver.

import { readFileSync } from 'node:fs';
import { basename } from 'node:path';

import { expect as expect_base, type Page } from '@playwright/test';

import {
  items,
  map_middle,
  map_pixels,
  metres_between,
  open_page,
  pixels_per_m,
  press,
  tab,
  type Color,
  type Pixel,
  type Point,
} from './page';
import { expect, real_file, test } from './station';

interface Mission {
  readonly items: readonly (Point & { readonly type: string })[];
}

/** Positions of a QGroundControl plan, read by this test itself. */
const plan_positions = (text: string): Point[] => {
  const plan = JSON.parse(text) as {
    mission: { items: { command?: number; params?: (number | null)[] }[] };
  };
  return plan.mission.items
    .filter(({ command }) => command === 16)
    .map(({ params = [] }) => ({ lat: params[4] ?? 0, lon: params[5] ?? 0 }));
};

/** Positions of a QGC WPL 110 file, home (row 0) left out. */
const waypoint_positions = (text: string): Point[] =>
  text
    .split('\n')
    .slice(2)
    .map((row) => row.trim().split(/\s+/))
    .filter((columns) => columns[3] === '16')
    .map((columns) => ({ lat: Number(columns[8]), lon: Number(columns[9]) }));

const FILES = [
  { name: 'mission-sitl.plan', format: 'plan', read: plan_positions },
  {
    name: 'mission-rover-basic.waypoints',
    format: 'waypoints',
    read: waypoint_positions,
  },
] as const;

const same_places = (found: readonly Point[], wanted: readonly Point[]): void => {
  expect_base(found).toHaveLength(wanted.length);
  wanted.forEach((point, k) => {
    expect_base(metres_between(found[k] as Point, point)).toBeLessThan(0.001);
  });
};

const export_text = async (page: Page, format: string): Promise<string> => {
  await page.getByRole('button', { name: /^More about/ }).click();
  await page.getByText('Save as a file').click();
  const download = page.waitForEvent('download');
  await page.getByRole('link', { name: `.${format}`, exact: true }).click();
  return readFileSync(await (await download).path(), 'utf8');
};

for (const { name, format, read } of FILES) {
  test(`${name} imports, shows on the map and exports with the same positions`, async ({
    page,
    station,
  }) => {
    const file = real_file(name);
    test.skip(file === null, `${name} is not on this machine (ROVERD_REAL_DATA)`);
    if (file === null) return;
    const wanted = read(readFileSync(file, 'utf8'));
    expect(wanted.length).toBeGreaterThan(2);

    await page.goto(station.url);
    await tab(page, 'Missions');
    await page.getByLabel('Mission file').setInputFiles(file);
    await expect(page.getByRole('dialog')).toContainText(`“${basename(file)}” became the mission`);
    await page.getByRole('button', { name: 'Continue' }).click();

    const list = await station.rest<{ items: { id: string }[] }>('GET', '/missions');
    const id = list.items[0]?.id ?? '';
    const mission = await station.rest<Mission>('GET', `/missions/${id}`);
    same_places(
      mission.items.filter(({ type }) => type === 'waypoint'),
      wanted,
    );

    same_places(read(await export_text(page, format)), wanted);

    await tab(page, 'Plan');
    await expect(items(page)).toHaveCount(mission.items.length);
    await expect(page.locator('.scale-bar')).toHaveText(/\d+ (cm|m|km)/);
  });
}

test('a broken file is refused with the reason, and nothing is stored', async ({
  page,
  station,
}) => {
  await page.goto(station.url);
  await tab(page, 'Missions');
  await page.getByLabel('Mission file').setInputFiles({
    name: 'broken.plan',
    mimeType: 'application/json',
    buffer: Buffer.from('{"fileType": "Plan", "mission": {"items": ['),
  });
  await expect(page.getByLabel('Messages')).toContainText('“broken.plan” was not imported');
  await expect(page.getByText('No missions stored yet.')).toBeVisible();
});

const FIXES: Color = [138, 109, 0];
const DRIVEN: Color = [168, 50, 122];
const ROBOT: Color = [17, 19, 24];
/** The receiver of a recording that is over says nothing more: its place is old. */
const ROBOT_STALE: Color = [138, 141, 147];
const HOME: Color = [95, 61, 196];
/** Around the robot and its home, and on both sides of the line. */
const CASING_PX = 4;

/** Metres to the east and to the south of a place. */
const offset_m = (from: Point, to: Point): Pixel => [
  Math.sign(to.lon - from.lon) * metres_between({ ...from, lat: to.lat }, to),
  Math.sign(from.lat - to.lat) * metres_between({ ...to, lat: from.lat }, to),
];

const middle_of = (points: readonly Point[]): Point => {
  const middle = (values: readonly number[]) => (Math.min(...values) + Math.max(...values)) / 2;
  return {
    lat: middle(points.map(({ lat }) => lat)),
    lon: middle(points.map(({ lon }) => lon)),
  };
};

const nearest_px = (at: Pixel, among: readonly Pixel[]): number =>
  Math.min(...among.map(([x, y]) => Math.hypot(x - at[0], y - at[1])));

/** From a line through these corners. */
const from_line_px = ([x, y]: Pixel, line: readonly Pixel[]): number => {
  let least = Infinity;
  for (let k = 1; k < line.length; k += 1) {
    const [[ax, ay], [bx, by]] = [line[k - 1] ?? [0, 0], line[k] ?? [0, 0]];
    const [dx, dy] = [bx - ax, by - ay];
    const along = ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1);
    const share = Math.min(1, Math.max(0, along));
    least = Math.min(least, Math.hypot(x - ax - share * dx, y - ay - share * dy));
  }
  return least;
};

/** Positions of an NMEA file, read by this test itself. */
const gga_positions = (text: string): Point[] => {
  const degrees = (value = '', minus: boolean): number => {
    const whole = Math.floor(Number(value) / 100);
    return (whole + (Number(value) - whole * 100) / 60) * (minus ? -1 : 1);
  };
  return text
    .split('\n')
    .map((line) => line.split(','))
    .filter(([kind = '', , lat = '']) => kind.endsWith('GGA') && lat !== '')
    .map((f) => ({
      lat: degrees(f[2], f[3] === 'S'),
      lon: degrees(f[4], f[5] === 'W'),
    }));
};

type Track = readonly (readonly (readonly [lat: number, lon: number, age_s: number])[])[];
interface Trail {
  readonly estimated: Track;
  readonly received: Track;
}
const points_of = (piece: Track[number]): Point[] => piece.map(([lat, lon]) => ({ lat, lon }));

/** Plays a recording to its end. @return the trail then */
const play_to_end = async (page: Page, url: string, last: Point): Promise<Trail> => {
  let trail: Trail = { estimated: [], received: [] };
  const to_go_m = async (): Promise<number> => {
    trail = (await (await page.request.get(`${url}/api/v1/vehicle/trail`)).json()) as Trail;
    const [lat, lon, age_s] = trail.received.flat().at(-1) ?? [0, 0, 0];
    // The recording ends with two seconds in one place.
    return age_s < 2 ? Infinity : metres_between({ lat, lon }, last);
  };
  await expect.poll(to_go_m, { timeout: 60_000 }).toBeLessThan(0.25);
  return trail;
};

test('a recorded RTK receiver is replayed, and its track is drawn for whoever comes late', async ({
  page,
  replay,
}) => {
  test.setTimeout(120_000);
  const file = real_file('gnss-nmea-rtk.log');
  test.skip(file === null, 'gnss-nmea-rtk.log is not on this machine (ROVERD_REAL_DATA)');
  if (file === null) return;
  const recorded = gga_positions(readFileSync(file, 'utf8'));
  expect(recorded.length).toBeGreaterThan(100);
  // One page looks on from the start. The other one is opened when everything is over.
  const url = await replay(file, 2);
  await page.goto(url);
  const trail = await play_to_end(page, url, recorded.at(-1) as Point);
  const late = await page.context().newPage();
  await late.goto(url);

  const middle = middle_of(points_of([...trail.estimated.flat(), ...trail.received.flat()]));
  for (const each of [page, late]) {
    await expect(each.getByRole('group', { name: 'Position' })).toContainText('RTK fixed');
    // Without a mission that shows the way so far, in the middle of the map.
    await press(each, 'Show the whole mission');
    await press(each, 'Zoom in');
    await expect(async () => {
      const [x, y] = await map_middle(each);
      const scale = await pixels_per_m(each);
      const on_screen = (at: Point): Pixel => {
        const [east_m, south_m] = offset_m(middle, at);
        return [x + east_m * scale, y + south_m * scale];
      };
      const recorded_px = recorded.map(on_screen);
      const pieces_px = trail.estimated.map((piece) => points_of(piece).map(on_screen));
      const dots = await map_pixels(each, [FIXES]);
      const line = await map_pixels(each, [DRIVEN]);
      const above = await map_pixels(each, [ROBOT, ROBOT_STALE, HOME, DRIVEN]);
      // How many pixels there are depends on the scale; that enough is drawn is asked below.
      expect(dots.length).toBeGreaterThan(0);
      expect(line.length).toBeGreaterThan(0);
      // Every dot is a recorded position, and every recorded position has its dot: half a dot and a
      // page that begins with its first message off, 7 px and 0.2 m to the next one. A tenth may
      // be missing on a busy machine.
      for (const dot of dots) expect(nearest_px(dot, recorded_px)).toBeLessThan(8);
      const bare = recorded_px.filter(
        (at) => nearest_px(at, dots) > 10 + 0.2 * scale && nearest_px(at, above) > 10 + CASING_PX,
      );
      expect(bare.length).toBeLessThan(0.1 * recorded_px.length);
      // The line goes where the robot believed it was, and does not jump.
      const off_line_px = (at: Pixel) => Math.min(...pieces_px.map((px) => from_line_px(at, px)));
      for (const at of line) expect(off_line_px(at)).toBeLessThan(8);
      // A page on a busy machine may cut a bend short where it missed a message.
      const way_px = pieces_px.filter((px) => px.length > 1).flat();
      const undrawn = way_px.filter((at) => nearest_px(at, above) > 8 + CASING_PX);
      expect(undrawn.length).toBeLessThan(0.05 * way_px.length);
    }).toPass({ timeout: 15_000 });
  }
});

test('files dropped anywhere are imported one after the other, and a fence is used only when asked', async ({
  page,
  station,
}) => {
  await open_page(page, station.url);
  const { lat, lon } = station.sim.now;
  const north = (m: number): number => lat + m / 111_250;
  const simple = (k: number, m: number) => ({
    type: 'SimpleItem',
    autoContinue: true,
    command: 16,
    doJumpId: k,
    frame: 3,
    params: [0, 0, 0, null, north(m), lon, 0],
  });
  const corner = (east: number, m: number): number[] => [north(m), lon + east];
  const plan = {
    fileType: 'Plan',
    version: 1,
    groundStation: 'hand',
    geoFence: {
      version: 2,
      circles: [],
      polygons: [
        {
          version: 1,
          inclusion: true,
          polygon: [corner(-0.001, -60), corner(0.001, -60), corner(0.001, 60), corner(-0.001, 60)],
        },
      ],
    },
    mission: {
      version: 2,
      firmwareType: 3,
      vehicleType: 10,
      cruiseSpeed: 1,
      hoverSpeed: 1,
      plannedHomePosition: [lat, lon, 0],
      items: [simple(1, 5), simple(2, 10)],
    },
    rallyPoints: { version: 2, points: [] },
  };
  const table = `lat,lon\n${north(3)},${lon}\n${north(6)},${lon}\n${north(9)},${lon}\n`;
  const files = [
    { name: 'with_fence.plan', text: JSON.stringify(plan) },
    { name: 'three.csv', text: table },
  ];
  const drag = (what: string): Promise<boolean> =>
    page.evaluate(
      ({ kind, held }) => {
        const data = new DataTransfer();
        for (const { name, text } of held) data.items.add(new File([text], name));
        const event = new DragEvent(kind, {
          dataTransfer: data,
          bubbles: true,
          cancelable: true,
        });
        return !document.querySelector('#map')?.dispatchEvent(event);
      },
      { kind: what, held: files },
    );
  expect(await drag('dragover')).toBe(true);
  await expect(page.getByText('Drop it: missions and maps are imported')).toBeVisible();
  expect(await drag('drop')).toBe(true);
  await expect(page.getByText('Drop it: missions and maps are imported')).toBeHidden();

  const dialog = page.getByRole('dialog');
  await expect(dialog).toContainText('with_fence.plan');
  const fence = () => station.rest<{ fence: { name: string } | null }>('GET', '/vehicle');
  expect((await fence()).fence).toBeNull();
  await dialog.getByRole('button', { name: 'Use it' }).click();
  await expect(dialog).toContainText('and is in force');
  expect((await fence()).fence).not.toBeNull();
  await dialog.getByRole('button', { name: 'Continue' }).click();

  await expect(dialog).toContainText('three.csv');
  await dialog.getByRole('button', { name: 'Continue' }).click();
  await expect(dialog).toBeHidden();
  await expect(items(page)).toHaveCount(3);
  const { items: kept } = await station.rest<{ items: unknown[] }>('GET', '/missions');
  expect(kept).toHaveLength(2);
});
