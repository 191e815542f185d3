// What was driven and how well, in rows that a person can compare.

import { degrees_text, duration, metres, number_text } from './format';

export type Outcome = 'running' | 'finished' | 'aborted' | 'interrupted';

export interface RunHead {
  readonly id: number;
  readonly begun: string;
  readonly ended: string | null;
  readonly outcome: Outcome;
  readonly mission_id: string;
  readonly revision: number;
  readonly name: string;
  readonly vehicle: string;
  readonly first_item: number;
}
export interface RunReport {
  readonly time_s: number;
  readonly driving_s: number;
  readonly driven_m: number;
  readonly energy_wh: number | null;
  readonly laps: number;
  /** The way to the first item; not judged. */
  readonly approach: { readonly time_s: number; readonly driven_m: number } | null;
  readonly judged_m: number;
  readonly cross_track: {
    readonly rms_m: number | null;
    readonly mean_m: number | null;
    readonly p95_m: number | null;
    readonly max_m: number | null;
  };
  readonly corner_mean_m: number | null;
  readonly corner_max_m: number | null;
  readonly cut_max_m: number | null;
  readonly overshoot_max_m: number | null;
  readonly slalom_max_m: number | null;
  readonly slalom_mean_m: number | null;
  readonly heading_rms_deg: number | null;
  readonly jerk_rms_mps3: number | null;
  readonly end_m: number | null;
  readonly corners: readonly {
    readonly item: number;
    readonly turn_deg: number;
    readonly distance_m: number;
    readonly cut_m: number;
    readonly overshoot_m: number;
  }[];
  readonly straights: readonly {
    readonly item: number;
    readonly length_m: number;
    readonly slalom_m: number;
  }[];
}

export const outcome_words: Record<Outcome, string> = {
  running: 'Running',
  finished: 'Finished',
  aborted: 'Aborted',
  interrupted: 'Interrupted',
};

interface Measure {
  readonly label: string;
  readonly value: (report: RunReport) => number | null;
  readonly text: (value: number | null) => string;
  /** Less is better; else it only describes. */
  readonly judged: boolean;
}

const measure = (
  label: string,
  value: Measure['value'],
  text: Measure['text'] = metres,
  judged = true,
): Measure => ({ label, value, text, judged });

const MEASURES: readonly Measure[] = [
  measure('Off the path, rms', (r) => r.cross_track.rms_m),
  measure('95 % of the time under', (r) => r.cross_track.p95_m),
  measure('At most', (r) => r.cross_track.max_m),
  measure('From corners, mean', (r) => r.corner_mean_m),
  measure('From corners, at most', (r) => r.corner_max_m),
  measure('Corner cut, at most', (r) => r.cut_max_m),
  measure('Overshoot, at most', (r) => r.overshoot_max_m),
  measure('Slalom on straights, mean', (r) => r.slalom_mean_m),
  measure('Slalom, at most', (r) => r.slalom_max_m),
  measure('Heading, rms', (r) => r.heading_rms_deg, degrees_text),
  measure(
    'Jerk, rms',
    (r) => r.jerk_rms_mps3,
    (v) => number_text(v, 2, 'm/s³'),
  ),
  measure('From the end point', (r) => r.end_m),
  measure('Time', (r) => r.time_s, duration),
  measure('Of it driving', (r) => r.driving_s, duration, false),
  measure('Driven', (r) => r.driven_m, metres, false),
  measure('Of it to the first item', (r) => r.approach?.driven_m ?? null, metres, false),
  measure(
    'Energy',
    (r) => r.energy_wh,
    (v) => number_text(v, 1, 'Wh'),
  ),
];

export interface ReportRow {
  readonly label: string;
  readonly first: string;
  /** Of the run it is compared with. */
  readonly second: string | null;
  /** Which one did better, where that can be said and is worth it. */
  readonly better: 'first' | 'second' | null;
}

/** Nearer to each other than this share they are alike. */
const ALIKE = 0.05;

const better_of = (first: number | null, second: number | null): ReportRow['better'] => {
  if (first === null || second === null) return null;
  const larger = Math.max(Math.abs(first), Math.abs(second));
  if (Math.abs(first - second) <= ALIKE * larger) return null;
  return first < second ? 'first' : 'second';
};

export const report_rows = (first: RunReport, second: RunReport | null): ReportRow[] =>
  MEASURES.map(({ label, value, text, judged }) => {
    const one = value(first);
    const other = second && value(second);
    return {
      label,
      first: text(one),
      second: second && text(other),
      better: judged && second ? better_of(one, other) : null,
    };
  });
