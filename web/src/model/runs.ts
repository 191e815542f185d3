// What was driven and how well, in rows that a person can compare.

import { degrees_text, duration, metres_as, number_text } from './format';
import type { Plan } from './plan';
import { type PlainKey, say_plain, told } from './say';

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
export interface RunEvent {
  readonly time: string;
  readonly level: string;
  readonly kind: string;
  readonly detail: string;
}
export interface RunDetail {
  readonly ended: string | null;
  readonly outcome: Outcome;
  readonly plan: Plan;
  readonly events: readonly RunEvent[];
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
  /** Items driven along what was seen: distance from the line that was seen then. */
  readonly by_sight: readonly {
    readonly item: number;
    readonly type: 'row' | 'wall' | 'landmarks';
    readonly driven_m: number;
    readonly judged_m: number;
    readonly rms_m: number | null;
    readonly max_m: number | null;
  }[];
}

export const outcome_words: Record<Outcome, string> = told({
  running: 'under_way',
  finished: 'finished',
  aborted: 'aborted',
  interrupted: 'interrupted',
});

interface Measure {
  readonly label: PlainKey;
  readonly value: (report: RunReport) => number | null;
  /** @param larger of the two that stand beside each other: they have one unit */
  readonly text: (value: number | null, larger: number | null) => string;
  /** Less is better; of what adds up only between runs that came to their end; else it only describes. */
  readonly judged: boolean | 'at_the_end';
}

const measure = (
  label: PlainKey,
  value: Measure['value'],
  text: Measure['text'] = metres_as,
  judged: Measure['judged'] = true,
): Measure => ({ label, value, text, judged });

const MEASURES: readonly Measure[] = [
  measure('off_the_path_rms', (r) => r.cross_track.rms_m),
  measure('n_95_percent_of_the_time_under', (r) => r.cross_track.p95_m),
  measure('at_most', (r) => r.cross_track.max_m),
  measure('from_corners_mean', (r) => r.corner_mean_m),
  measure('from_corners_at_most', (r) => r.corner_max_m),
  measure('corner_cut_at_most', (r) => r.cut_max_m),
  measure('overshoot_at_most', (r) => r.overshoot_max_m),
  measure('slalom_on_straights_mean', (r) => r.slalom_mean_m),
  measure('slalom_at_most', (r) => r.slalom_max_m),
  measure('heading_rms', (r) => r.heading_rms_deg, degrees_text),
  measure(
    'jerk_rms',
    (r) => r.jerk_rms_mps3,
    (v) => number_text(v, 2, 'm/s³'),
  ),
  measure('from_the_end_point', (r) => r.end_m),
  measure('time', (r) => r.time_s, duration, 'at_the_end'),
  measure('of_it_driving', (r) => r.driving_s, duration, false),
  measure('driven', (r) => r.driven_m, metres_as, false),
  measure('of_it_to_the_first_item', (r) => r.approach?.driven_m ?? null, metres_as, false),
  measure(
    'energy',
    (r) => r.energy_wh,
    (v) => number_text(v, 1, 'Wh'),
    'at_the_end',
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

const larger_of = (first: number | null, second: number | null): number | null =>
  first === null || second === null ? (first ?? second) : Math.max(first, second);

/** Nearer to each other than this share they are alike. */
const ALIKE = 0.05;

const better_of = (first: number | null, second: number | null): ReportRow['better'] => {
  if (first === null || second === null) return null;
  const larger = Math.max(Math.abs(first), Math.abs(second));
  if (Math.abs(first - second) <= ALIKE * larger) return null;
  return first < second ? 'first' : 'second';
};

/** @param ended both of them came to their end */
export const report_rows = (
  first: RunReport,
  second: RunReport | null,
  ended = true,
): ReportRow[] =>
  MEASURES.map(({ label, value, text, judged }) => {
    const counts = judged === 'at_the_end' ? ended : judged;
    const one = value(first);
    const other = second && value(second);
    const larger = larger_of(one, other);
    return {
      label: say_plain(label),
      first: text(one, larger),
      second: second && text(other, larger),
      better: counts && second ? better_of(one, other) : null,
    };
  });
