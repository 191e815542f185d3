import { describe, expect, test } from 'vitest';

import { heat_of } from '../src/model/heat';
import { is_stretch, mark_strength, plots_of, shown_range } from '../src/model/run_plot';
import {
  event_place,
  index_at,
  lines_of,
  moment_at,
  shade_words,
  shades_of,
  track_of_csv,
  UNKNOWN_SHADE,
  type RunTrack,
} from '../src/model/run_track';

const HEAD =
  'time,t_s,lat,lon,heading_deg,speed_mps,yaw_rate_dps,accuracy_m,cross_track_m,item,lap,power_w,by_itself';
const METRE = 1 / 111_320; // of latitude at the equator, nearly

interface Row {
  readonly t_s: number;
  readonly north_m: number;
  readonly speed?: string;
  readonly off?: string;
  readonly lap?: number;
}
const table = (rows: readonly Row[]): string =>
  [
    HEAD,
    ...rows.map(
      ({ t_s, north_m, speed = '1.000', off = '', lap = 1 }) =>
        `2026-05-01T10:00:00.000Z,${t_s},${(north_m * METRE).toFixed(9)},0.000000000,0.00,${speed},0.00,0.020,${off},2,${lap},,1`,
    ),
    '',
  ].join('\n');

const track = (rows: readonly Row[]): RunTrack => {
  const read = track_of_csv(table(rows));
  if (!read) throw new Error('no track');
  return read;
};

describe('the table of a run', () => {
  test('is read by the names of its columns, empty cells are not known', () => {
    const { size, t_s, cross_track_m, power_w, item, way_m } = track([
      { t_s: 0, north_m: 0, off: '-0.031' },
      { t_s: 0.2, north_m: 0.2 },
    ]);
    expect(size).toBe(2);
    expect([...t_s]).toEqual([0, 0.2]);
    expect(cross_track_m[0]).toBe(-0.031);
    expect(cross_track_m[1]).toBeNaN();
    expect(power_w[0]).toBeNaN();
    expect(item[1]).toBe(2);
    expect(way_m[1]).toBeCloseTo(0.2, 2);
  });

  test('of a run that never moved is empty, and other text is none', () => {
    expect(track_of_csv(`${HEAD}\n`)?.size).toBe(0);
    expect(track_of_csv('<html>')).toBeNull();
    expect(moment_at(track([]), 'time', 3)).toBeNull();
    expect(lines_of(track([]))).toEqual([]);
  });

  test('joins no line over a jump nor from one lap to the next, and a jump is no way', () => {
    const jumps = track([
      { t_s: 0, north_m: 0 },
      { t_s: 0.2, north_m: 0.2 },
      { t_s: 0.4, north_m: 40 },
      { t_s: 0.6, north_m: 40.2, lap: 2 },
    ]);
    expect(lines_of(jumps).map(({ length }) => length)).toEqual([2, 1, 1]);
    expect(jumps.way_m[3]).toBeCloseTo(0.4, 2);
  });
});

test('the sample of a moment is the last one that is not behind it', () => {
  const column = Float64Array.of(0, 0.2, 0.4, 0.4, 0.6);
  expect([-1, 0, 0.19, 0.2, 0.4, 0.5, 9].map((x) => index_at(column, x))).toEqual([
    0, 0, 0, 1, 3, 3, 4,
  ]);
  expect(index_at(new Float64Array(), 1)).toBe(-1);
});

test('an event stands where the robot was at its time', () => {
  const driven = track([0, 1, 2, 3].map((k) => ({ t_s: k, north_m: k })));
  const [begun, time] = ['2026-05-01T10:00:00.000Z', '2026-05-01T10:00:02.500Z'];
  expect(event_place(driven, 'time', begun, time)).toBe(2.5);
  expect(event_place(driven, 'way', begun, time)).toBeCloseTo(2, 1);
});

describe('shades', () => {
  const driven = track([
    { t_s: 0, north_m: 0, off: '0.020', speed: '0' },
    { t_s: 1, north_m: 1, off: '-0.3', speed: '-1.000' },
    { t_s: 2, north_m: 2, off: '7', speed: '0.500' },
    { t_s: 3, north_m: 3 },
  ]);

  test('grow with the distance from the path, to either side', () => {
    const shades = shades_of(driven, 'deviation');
    expect([...(shades.of[0] ?? [])]).toEqual([0, 4, 5, UNKNOWN_SHADE]);
    // in the unit of the report
    expect(shade_words(shades)).toEqual([
      'to 2 cm',
      'to 5 cm',
      'to 10 cm',
      'to 20 cm',
      'to 50 cm',
      'more',
    ]);
  });

  test('of speed go up to the fastest of this run, also in reverse', () => {
    const shades = shades_of(driven, 'speed');
    expect([...(shades.of[0] ?? [])]).toEqual([0, 5, 2, 5]);
    expect(shade_words(shades)).toEqual([
      'to 0.2 m/s',
      'to 0.4 m/s',
      'to 0.6 m/s',
      'to 0.8 m/s',
      'to 0.95 m/s',
      'more',
    ]);
    expect(shade_words(shades, 'km/h').slice(3)).toEqual(['to 2.88 km/h', 'to 3.42 km/h', 'more']);
  });
});

describe('plots', () => {
  const slow = track([0, 2, 4].map((k) => ({ t_s: k, north_m: k / 2, speed: '0.5' })));
  const quick = track([0, 1, 2].map((k) => ({ t_s: k, north_m: k, off: '0.1' })));

  test('of one run leave out what nobody measured', () => {
    const plots = plots_of(slow, null, 'time');
    expect(plots.map(({ label }) => label)).toEqual(['Speed, m/s', 'Accuracy, cm']);
    expect(plots[0]?.data).toEqual([
      [0, 2, 4],
      [0.5, 0.5, 0.5],
    ]);
    const [in_kmh] = plots_of(slow, null, 'time', 'km/h');
    expect(in_kmh).toEqual({
      label: 'Speed, km/h',
      data: [
        [0, 2, 4],
        [1.8, 1.8, 1.8],
      ],
    });
  });

  test('of two runs lie over one axis; who has ended draws nothing more', () => {
    const off = plots_of(slow, quick, 'time').find(({ label }) => label.startsWith('Off'));
    expect(off?.data).toEqual([
      [0, 1, 2, 4],
      [null, null, null, null],
      [10, 10, 10, null],
    ]);
  });
});

describe('several runs in one picture', () => {
  const straight = (off: string) =>
    track([0, 1, 2, 3, 4].map((k) => ({ t_s: k, north_m: k, off, speed: '1' })));

  test('count each run once in each square, however slowly it drove, and leave no gap', () => {
    const { cell_m, cells } = heat_of([straight('0.1'), straight('-0.3')]);
    expect(cell_m).toBe(0.25);
    expect(cells.every(({ runs }) => runs === 2)).toBe(true);
    expect(cells.length).toBeGreaterThanOrEqual(16);
    expect(cells[0]?.off_m).toBeCloseTo(0.2, 6);
  });

  test('need larger squares where much was driven, and none where nothing was', () => {
    const far = track(
      Array.from({ length: 12_000 }, (_, k) => ({ t_s: k, north_m: k, speed: '1' })),
    );
    const { cell_m, cells } = heat_of([far]);
    expect(cell_m).toBe(1);
    expect(cells.length).toBeLessThanOrEqual(20_000);
    expect(cells[0]?.off_m).toBeNull();
    expect(heat_of([track([])]).cells).toEqual([]);
  });
});

describe('the axis of a plot', () => {
  test('is no taller than a metre per second of a robot that stood', () => {
    expect(shown_range(0, 0)).toEqual([0, 0.5]);
    expect(shown_range(null, null)).toEqual([0, 0.5]);
    expect(shown_range(-0.1, 0.1)).toEqual([-0.5, 0.5]);
  });

  test('holds what is plotted, and begins at nought where it is never below', () => {
    expect(shown_range(0, 100)).toEqual([0, 106]);
    expect(shown_range(-10, 10)).toEqual([-11.2, 11.2]);
    const [least, most] = shown_range(40, 40.2);
    expect(least).toBeGreaterThan(39);
    expect(most).toBeLessThan(41);
  });

  test('shows a stretch if not the whole run is seen', () => {
    const x = Float64Array.of(0, 1, 2, 3);
    expect(is_stretch(x, 0, 3)).toBe(false);
    expect(is_stretch(x, 0, 2.5)).toBe(true);
    expect(is_stretch(x, 1, 3)).toBe(true);
    // Of one sample, or of none, there is nothing to draw out.
    expect(is_stretch([2], 1.8, 2.2)).toBe(false);
    expect(is_stretch([], 0, 100)).toBe(false);
  });

  test('keeps its curve in sight below many events', () => {
    expect(mark_strength(1)).toBe(1);
    expect(mark_strength(30)).toBe(1);
    expect(mark_strength(292)).toBeLessThan(0.2);
    expect(mark_strength(292)).toBeGreaterThan(0.1);
  });
});
