// What the rooms hand each other of what was driven: types only.

import type { Answer } from './answer';
import type { LatLon } from './plan';
import type { Page } from './ports';
import type { Moment, RunTrack, Shades } from './run_track';
import type { RunDetail, RunHead, RunReport } from './runs';

export interface RunCalls {
  list(cursor: string | null): Promise<Answer<Page<RunHead>>>;
  report(id: number): Promise<Answer<RunReport>>;
  /** Where it drove, and how. */
  track(id: number): Promise<Answer<RunTrack>>;
  /** The mission as it was driven, and what happened. */
  detail(id: number): Promise<Answer<RunDetail>>;
  /** A file for others: what a phone hands to its other programs. */
  track_file(id: number, format: 'csv' | 'gpx' | 'geojson'): Promise<Answer<ArrayBuffer>>;
  track_address(id: number, format: 'csv' | 'gpx' | 'geojson'): string;
}
export interface RunOnMap {
  /** What it drove, lap by lap. */
  readonly lines: readonly (readonly LatLon[])[];
  readonly planned: readonly LatLon[];
  /** The line's colours; left out: the run's own. */
  readonly shades?: Shades | null;
  /** Where it was at the moment that is looked at. */
  readonly at?: Moment | null;
}
