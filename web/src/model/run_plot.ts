// Columns for the plots of one run, or of two over one axis.

import { type PlainKey, say, say_plain } from './say';
import { axis_of, type Axis, type RunTrack } from './run_track';
import { shown_per, type SpeedUnit } from './settings';

interface PlotSpec {
  readonly label: PlainKey;
  readonly column: 'speed_mps' | 'cross_track_m' | 'accuracy_m' | 'power_w';
}
const SPECS: readonly PlotSpec[] = [
  { label: 'off_the_path_cm_left_plus', column: 'cross_track_m' },
  { label: 'speed', column: 'speed_mps' },
  { label: 'accuracy_cm', column: 'accuracy_m' },
  { label: 'power_w', column: 'power_w' },
];

/** What the axis shows of values between two, in its unit: else that of a robot that stood would reach to
 * 100 m/s. */
export const shown_range = (least: number | null, most: number | null): [number, number] => {
  const [low, high] = [least ?? 0, most ?? 0];
  const margin = Math.max(0.06 * (high - low), (1 - high + low) / 2);
  return [low >= 0 && low < margin ? 0 : low - margin, high + margin];
};

/** How strongly the lines of events are drawn: many of them would hide the curves. */
export const mark_strength = (marks: number): number => Math.max(0.15, Math.min(1, 30 / marks));

/** @param x in order @return whether from min to max is a stretch that somebody drew out of it */
export const is_stretch = (x: ArrayLike<number>, min: number, max: number): boolean =>
  min > (x[0] ?? min) || max < (x[x.length - 1] ?? max);

type Values = readonly (number | null)[];
export interface Plot {
  readonly label: string;
  /** x, the run, and the other one if there is one. */
  readonly data: readonly [readonly number[], ...Values[]];
}

const value_at = (column: Float64Array, k: number): number | null => {
  const value = column[k];
  return value === undefined || Number.isNaN(value) ? null : value;
};

/** How many of the unit that is shown make one of the column's: distances from the way as the report has them. */
const shown_of = (column: PlotSpec['column'], speed: SpeedUnit): number => {
  if (column === 'speed_mps') return shown_per('m/s', speed);
  return column === 'power_w' ? 1 : 100;
};

/** In the unit of this device. */
const plot_of = (
  { label, column }: PlotSpec,
  speed: SpeedUnit,
  [x, ...values]: Plot['data'],
): Plot => {
  const per = shown_of(column, speed);
  const shown = values.map((each) => each.map((value) => value && value * per));
  const title = column === 'speed_mps' ? say('speed_speed', { speed }) : say_plain(label);
  return { label: title, data: [x, ...shown] };
};

/** Whoever is compared is known at each place of both; between its own samples by the last one. */
const merged = (first: Float64Array, second: Float64Array) => {
  const x: number[] = [];
  const one: number[] = [];
  const other: number[] = [];
  let a = 0;
  let b = 0;
  while (a < first.length || b < second.length) {
    const next = Math.min(first[a] ?? Infinity, second[b] ?? Infinity);
    while (a < first.length && (first[a] ?? 0) <= next) a += 1;
    while (b < second.length && (second[b] ?? 0) <= next) b += 1;
    x.push(next);
    one.push(next > (first[first.length - 1] ?? 0) ? -1 : a - 1);
    other.push(next > (second[second.length - 1] ?? 0) ? -1 : b - 1);
  }
  return { x, one, other };
};

const has_values = (values: Values): boolean => values.some((value) => value !== null);

/** Those that tell anything. @param second null: one run alone */
export const plots_of = (
  first: RunTrack,
  second: RunTrack | null,
  axis: Axis,
  speed: SpeedUnit = 'm/s',
): Plot[] => {
  const along = axis_of(first, axis);
  if (!second) {
    const x = [...along];
    return SPECS.map((spec) =>
      plot_of(spec, speed, [x, x.map((_, k) => value_at(first[spec.column], k))]),
    ).filter(({ data }) => has_values(data[1] ?? []));
  }
  const { x, one, other } = merged(along, axis_of(second, axis));
  return SPECS.map((spec) =>
    plot_of(spec, speed, [
      x,
      one.map((k) => value_at(first[spec.column], k)),
      other.map((k) => value_at(second[spec.column], k)),
    ]),
  ).filter(({ data }) => data.slice(1).some((values) => has_values(values as Values)));
};
