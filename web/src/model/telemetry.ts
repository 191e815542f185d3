// What is plotted, as columns, one per signal, in a bounded window of the latest samples. A value that
// is unknown is null and leaves a gap in the line.

import { type PlainKey } from './say';
import { shown_per, type SpeedUnit } from './settings';
import type { Vehicle } from './vehicle';

export interface Signal {
  readonly id: string;
  readonly label: PlainKey;
  readonly unit: string;
  /** Its column in a file, without the unit, where the id alone would be taken for something else. */
  readonly column?: string;
}
/** In the order of the columns behind the time. */
export const SIGNALS = [
  { id: 'speed', label: 'speed', unit: 'm/s' },
  { id: 'deviation', label: 'off_path', unit: 'm' },
  { id: 'heading', label: 'heading_error', unit: '°', column: 'heading_error' },
  { id: 'battery', label: 'battery', unit: 'V' },
  { id: 'link', label: 'link_there_and_back', unit: 'ms' },
  { id: 'gnss', label: 'gnss_accuracy', unit: 'm' },
] as const satisfies readonly Signal[];
export type SignalId = (typeof SIGNALS)[number]['id'];

export type Columns = [t_s: number[], ...signals: (number | null)[][]];

/** Five minutes at ten a second. */
export const KEPT = 3000;
/** Dropped at once, so that not every sample moves all others. */
const SLACK = 200;

/** Nearer to its item than this, the direction to it means nothing. */
const NEAR_M = 0.5;

/** From where it heads, or its tail where it backs, to the item in hand: clockwise positive, degrees in
 * [-180, 180). Null: nothing is driven to, or it is there. */
export const heading_error_deg = ({ position, mission }: Vehicle): number | null => {
  const { heading_deg, speed_mps } = position;
  const { bearing_to_item_deg, distance_to_item_m, state } = mission;
  const known = state === 'running' && heading_deg !== null && bearing_to_item_deg !== null;
  if (!known || (distance_to_item_m ?? 0) < NEAR_M) return null;
  const faces_deg = heading_deg + (speed_mps !== null && speed_mps < -0.02 ? 180 : 0);
  return ((((bearing_to_item_deg - faces_deg + 180) % 360) + 360) % 360) - 180;
};

const fresh = <T>(group: { readonly stale: boolean }, value: T | null): T | null =>
  group.stale ? null : value;

/** In the order of SIGNALS. @param round_trip_s null: not known */
export const sample_of = (
  vehicle: Vehicle,
  round_trip_s: number | null,
): readonly (number | null)[] => {
  const { position, mission, battery, gnss } = vehicle;
  return [
    fresh(position, position.speed_mps),
    fresh(position, mission.cross_track_m),
    fresh(position, heading_error_deg(vehicle)),
    fresh(battery, battery.battery_v),
    round_trip_s === null ? null : 1000 * round_trip_s,
    fresh(gnss, gnss.horizontal_accuracy_m),
  ];
};

export class Telemetry {
  readonly columns: Columns = [[], ...SIGNALS.map(() => [])];

  /** Time must grow. @return false: it did not, and nothing was taken */
  take(t_s: number, values: readonly (number | null)[]): boolean {
    const [times, ...signals] = this.columns;
    const last = times.at(-1);
    if (last !== undefined && t_s <= last) return false;
    times.push(t_s);
    signals.forEach((column, k) => column.push(values[k] ?? null));
    if (times.length > KEPT + SLACK) {
      for (const column of this.columns) column.splice(0, column.length - KEPT);
    }
    return true;
  }

  /** As it is now: it does not go on. */
  frozen(): Columns {
    const [times, ...signals] = this.columns;
    return [[...times], ...signals.map((column) => [...column])];
  }
}

/** A signal in the unit of this device. */
export const shown_pair_of = (
  columns: Columns,
  { id, unit }: Signal & { readonly id: SignalId },
  speed: SpeedUnit,
): [number[], (number | null)[]] => {
  const [times, values] = pair_of(columns, id);
  const per = shown_per(unit, speed);
  return [times, per === 1 ? values : values.map((value) => value && value * per)];
};

/** Time and one signal. */
export const pair_of = (columns: Columns, id: SignalId): [number[], (number | null)[]] => [
  columns[0],
  columns[1 + SIGNALS.findIndex((signal) => signal.id === id)] as (number | null)[],
];

/** What an axis shows of values between two: never less than a fiftieth of them, so that a battery that sags
 * by a tenth of a volt is seen, and noise does not fill it. */
export const value_range = (
  least: number | null,
  most: number | null,
): readonly [number, number] => {
  if (least === null || most === null) return [0, 1];
  const span = Math.max(most - least, 0.02 * Math.max(Math.abs(least), Math.abs(most)), 0.2);
  const middle = (least + most) / 2;
  return [middle - 0.55 * span, middle + 0.55 * span];
};

/** As other programs read it. Times: UTC, RFC 3339; what is unknown is empty. */
export const csv_of = ([times, ...signals]: Columns): string => {
  const signals_of: readonly Signal[] = SIGNALS;
  const head = [
    'time',
    ...signals_of.map(({ id, unit, column }) => `${column ?? id}_${unit.replace('/', 'p')}`),
  ];
  const lines = times.map((t_s, row) =>
    [
      new Date(1000 * t_s).toISOString(),
      ...signals.map((column) => {
        const value = column[row] ?? null;
        return value === null ? '' : String(Number(value.toFixed(4)));
      }),
    ].join(','),
  );
  return `${[head.join(',').replace('°', 'deg'), ...lines].join('\r\n')}\r\n`;
};
