// The log as it is read: what comes and goes again and again is one line with how often, not a page full.

import { event_shape } from './happened';
import type { StationEvent } from './vehicle';

export interface LogRow {
  /** The newest of them. */
  readonly event: StationEvent;
  readonly times: number;
}

/** What alternates, as "lost" and "back" do, is counted as well. */
const LOOKS_BACK = 3;

/** @param events the newest first, as the rows are */
export const log_rows = (events: readonly StationEvent[]): readonly LogRow[] => {
  const rows: LogRow[] = [];
  for (const event of events) {
    const shape = event_shape(event);
    const from = Math.max(0, rows.length - LOOKS_BACK);
    const found = rows.findIndex((row, k) => k >= from && event_shape(row.event) === shape);
    const row = rows[found];
    if (row) rows[found] = { ...row, times: row.times + 1 };
    else rows.push({ event, times: 1 });
  }
  return rows;
};
