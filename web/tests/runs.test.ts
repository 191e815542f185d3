import { describe, expect, test } from 'vitest';

import { wants_origin } from '../src/model/answer';
import { tags_of } from '../src/model/format';
import { report_rows, type RunReport } from '../src/model/runs';

const report: RunReport = {
  time_s: 100,
  driving_s: 90,
  driven_m: 80,
  energy_wh: null,
  laps: 1,
  approach: null,
  judged_m: 80,
  cross_track: { rms_m: 0.02, mean_m: 0.01, p95_m: 0.05, max_m: 0.12 },
  corner_mean_m: 0.03,
  corner_max_m: 0.06,
  cut_max_m: 0.04,
  overshoot_max_m: 0.01,
  slalom_max_m: 0.03,
  slalom_mean_m: 0.02,
  heading_rms_deg: 1.25,
  jerk_rms_mps3: 0.4,
  end_m: 0.02,
  corners: [],
  straights: [],
  by_sight: [],
};
const row = (label: string, second: RunReport | null) =>
  report_rows(report, second).find((each) => each.label === label);

describe('report', () => {
  test('says nothing of how a run of two centimetres was driven', () => {
    const short: RunReport = {
      ...report,
      cross_track: { rms_m: null, mean_m: null, p95_m: null, max_m: null },
      heading_rms_deg: null,
      approach: { time_s: 4, driven_m: 2.5 },
      judged_m: 0.02,
    };
    const rows = report_rows(short, report);
    const of = (label: string) => rows.find((each) => each.label === label);
    expect(of('Off the path, rms')).toMatchObject({ first: '—', better: null });
    expect(of('Heading, rms')?.first).toBe('—');
    expect(of('Of it to the first item, not judged')).toMatchObject({
      first: '2.50 m',
      second: '—',
    });
  });

  test('shows one run alone, an unknown energy as unknown', () => {
    expect(row('Off the path, rms', null)).toEqual({
      label: 'Off the path, rms',
      first: '2.0 cm',
      second: null,
      better: null,
    });
    expect(row('Energy', null)?.first).toBe('—');
    expect(row('Time', null)?.first).toBe('1 min 40 s');
  });

  test('a run that was broken off was not quicker than one that came to its end', () => {
    const broken: RunReport = { ...report, time_s: 5 };
    const time = (ended: boolean) =>
      report_rows(report, broken, ended).find(({ label }) => label === 'Time');
    expect(time(true)?.better).toBe('second');
    expect(time(false)).toMatchObject({ second: '5 s', better: null });
  });

  test('two distances beside each other have one unit', () => {
    const other = { ...report, cut_max_m: 0.14, driven_m: 1240 };
    expect(row('Corner cut, at most', other)).toMatchObject({ first: '0.04 m', second: '0.14 m' });
    expect(row('Driven', other)).toMatchObject({ first: '0.08 km', second: '1.24 km' });
    // alone it has its own
    expect(row('Corner cut, at most', null)?.first).toBe('4.0 cm');
  });

  test('marks the better one of two, where they differ enough', () => {
    const other = {
      ...report,
      cross_track: { ...report.cross_track, rms_m: 0.04, p95_m: 0.051 },
      time_s: 80,
      driven_m: 10,
      energy_wh: 12,
    };
    expect(row('Off the path, rms', other)).toMatchObject({ second: '4.0 cm', better: 'first' });
    expect(row('95 % of the time under', other)?.better).toBeNull();
    expect(row('Time', other)?.better).toBe('second');
    // How far it drove is no merit, and what is not known cannot be compared.
    expect(row('Driven', other)?.better).toBeNull();
    expect(row('Energy', other)?.better).toBeNull();
  });
});

test('tags are words between commas, each once', () => {
  expect(tags_of(' rows, Field 3 ,, rows ')).toEqual(['rows', 'Field 3']);
  expect(tags_of('  ')).toEqual([]);
});

test('only a missing origin is asked for', () => {
  const refusal = (detail: string) => ({
    status: 422,
    title: '',
    detail: '',
    errors: [{ pointer: 'line 1', detail }],
  });
  expect(wants_origin(refusal('needs an origin: a line "# origin LAT LON" before it'))).toBe(true);
  expect(wants_origin(refusal('must be a number'))).toBe(false);
});
