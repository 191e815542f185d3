// What was driven: the list, one run's report and pictures, a second run beside it, and several as one
// picture.

import { refusal_text } from '../model/answer';
import { heat_of, type Heat } from '../model/heat';
import { spots, type LatLon } from '../model/plan';
import type { RunCalls, RunOnMap } from '../model/run_ports';
import {
  axis_of,
  lines_of,
  moment_at,
  shades_of,
  type Axis,
  type Moment,
  type RunTrack,
  type ShadeBy,
  type Shades,
} from '../model/run_track';
import type { RunEvent, RunHead, RunReport } from '../model/runs';
import { say } from '../model/say';
import { again_and_again } from './again_and_again';

export interface OpenRun {
  readonly head: RunHead;
  readonly report: RunReport | null;
  /** Why there is no report. */
  readonly failure: string | null;
  readonly track: RunTrack | null;
  readonly events: readonly RunEvent[];
  readonly lines: readonly (readonly LatLon[])[];
  readonly planned: readonly LatLon[];
}

/** So many make one picture. */
export const MOST_IN_HEAT = 10;

/** A run that is under way is read again after so long, and after so many times as long as reading took:
 * a page that drives beside this needs the link. */
const READ_AGAIN_MS = 5000;
const READ_AGAIN_TIMES = 9;
const LOOK_MS = 1000;

export class Runs {
  items = $state.raw<readonly RunHead[]>([]);
  next_cursor = $state.raw<string | null>(null);
  loading = $state(false);
  failure = $state<string | null>(null);
  first = $state.raw<OpenRun | null>(null);
  second = $state.raw<OpenRun | null>(null);
  shade_by = $state<ShadeBy>('deviation');
  axis = $state<Axis>('time');
  /** On the axis; null: no moment is looked at. */
  moment_x = $state<number | null>(null);
  /** Runs that are chosen for one picture; null: none is made. */
  chosen = $state.raw<ReadonlySet<number> | null>(null);
  heat = $state.raw<Heat | null>(null);

  shades = $derived<Shades | null>(
    this.first?.track && this.second === null && this.shade_by !== 'run'
      ? shades_of(this.first.track, this.shade_by)
      : null,
  );
  moments = $derived<readonly (Moment | null)[]>(
    [this.first, this.second].map((run) =>
      run?.track && this.moment_x !== null ? moment_at(run.track, this.axis, this.moment_x) : null,
    ),
  );
  on_map = $derived<readonly RunOnMap[]>(
    [this.first, this.second].flatMap((run, k) => {
      if (!run) return [];
      const { lines, planned } = run;
      const shades = k === 0 ? this.shades : null;
      return [{ lines, planned, shades, at: this.moments[k] ?? null }];
    }),
  );
  /** Where the axis ends: of the longer one. */
  end_x = $derived(
    Math.max(
      0,
      ...[this.first, this.second].map((run) => {
        const column = run?.track ? axis_of(run.track, this.axis) : [];
        return column[column.length - 1] ?? 0;
      }),
    ),
  );

  readonly #calls: RunCalls;
  /** When what was read last is old. */
  #old_ms = 0;

  constructor(calls: RunCalls) {
    this.#calls = calls;
  }

  refresh = (): Promise<void> => this.#fetch(null);

  async more(): Promise<void> {
    if (this.next_cursor !== null) await this.#fetch(this.next_cursor);
  }

  /** @return the places of its track, to be shown on the map */
  async open(head: RunHead): Promise<readonly LatLon[]> {
    this.loading = true;
    this.second = null;
    this.moment_x = null;
    this.first = await this.#read(head);
    this.loading = false;
    return this.first.lines.flat();
  }

  /** The open run goes on while somebody looks at it. @param id of it @return ends it */
  follow(id: number): () => void {
    return again_and_again(async () => {
      const { first } = this;
      if (first?.head.id !== id || performance.now() < this.#old_ms) return () => undefined;
      const now = await this.#read(first.head);
      return () => {
        // Without an answer stays what is known.
        if (this.first?.head.id !== id || !now.track) return;
        this.first = now;
        this.items = this.items.map((each) => (each.id === id ? now.head : each));
      };
    }, LOOK_MS);
  }

  /** @param id of another run; null: none */
  async compare(id: number | null): Promise<void> {
    const head = this.items.find((run) => run.id === id);
    this.second = null;
    if (!head) return;
    this.loading = true;
    const second = await this.#read(head);
    this.loading = false;
    if (this.first) this.second = second;
  }

  close(): void {
    this.first = null;
    this.second = null;
    this.moment_x = null;
  }

  look_along(axis: Axis): void {
    const moment = this.moments[0];
    this.axis = axis;
    if (moment) this.moment_x = axis === 'time' ? moment.t_s : moment.way_m;
  }

  /** Begins with the newest of one mission: what one wants to compare most often. */
  choose_several(): void {
    const mission = this.items[0]?.mission_id;
    const alike = this.items.filter(({ mission_id }) => mission_id === mission);
    this.chosen = new Set(alike.slice(0, MOST_IN_HEAT).map(({ id }) => id));
  }

  choose(id: number, wanted: boolean): void {
    const chosen = new Set(this.chosen);
    if (wanted && chosen.size < MOST_IN_HEAT) chosen.add(id);
    else chosen.delete(id);
    this.chosen = chosen;
    this.heat = null;
  }

  /** One after the other: a page that drives beside this has the link for itself in between.
   * @return places of the picture */
  async make_heat(): Promise<readonly LatLon[]> {
    const tracks: RunTrack[] = [];
    this.loading = true;
    this.failure = null;
    for (const id of this.chosen ?? []) {
      const track = await this.#calls.track(id);
      if (track.ok) tracks.push(track.value);
      else this.failure = refusal_text(track.refusal);
    }
    this.loading = false;
    if (this.chosen === null) return [];
    this.heat = heat_of(tracks);
    return this.heat.cells;
  }

  leave_several(): void {
    this.chosen = null;
    this.heat = null;
  }

  track_address(id: number, format: 'csv' | 'gpx' | 'geojson'): string {
    return this.#calls.track_address(id, format);
  }

  /** Hands the track to other programs of this device. @return why not; null: done, or given up */
  async share(head: RunHead): Promise<string | null> {
    const answer = await this.#calls.track_file(head.id, 'gpx');
    if (!answer.ok) return refusal_text(answer.refusal);
    const file = new File([answer.value], `run-${head.id}.gpx`, { type: 'application/gpx+xml' });
    if (!navigator.canShare({ files: [file] })) return say('this_device_does_not_share_such_files');
    try {
      await navigator.share({ files: [file], title: head.name });
    } catch (cause) {
      const given_up = cause instanceof DOMException && cause.name === 'AbortError';
      return given_up ? null : say('this_device_did_not_share_it');
    }
    return null;
  }

  async #read(head: RunHead): Promise<OpenRun> {
    const since_ms = performance.now();
    const [report, track, detail] = await Promise.all([
      this.#calls.report(head.id),
      this.#calls.track(head.id),
      this.#calls.detail(head.id),
    ]);
    const now_ms = performance.now();
    this.#old_ms = now_ms + Math.max(READ_AGAIN_MS, READ_AGAIN_TIMES * (now_ms - since_ms));
    const { ended, outcome } = detail.ok ? detail.value : head;
    return {
      head: { ...head, ended, outcome },
      report: report.ok ? report.value : null,
      failure: report.ok ? null : refusal_text(report.refusal),
      track: track.ok ? track.value : null,
      events: detail.ok ? detail.value.events : [],
      lines: track.ok ? lines_of(track.value) : [],
      planned: detail.ok ? spots(detail.value.plan) : [],
    };
  }

  async #fetch(cursor: string | null): Promise<void> {
    this.loading = true;
    const answer = await this.#calls.list(cursor);
    this.loading = false;
    if (!answer.ok) {
      this.failure = refusal_text(answer.refusal);
      return;
    }
    this.failure = null;
    this.items = cursor === null ? answer.value.items : [...this.items, ...answer.value.items];
    this.next_cursor = answer.value.next_cursor;
  }
}
