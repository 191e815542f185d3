// What was driven: the list, one run's report, and a second run beside it.

import { refusal_text } from '../model/answer';
import { spots, type LatLon } from '../model/plan';
import type { RunCalls, RunOnMap } from '../model/ports';
import type { RunHead, RunReport } from '../model/runs';

export interface OpenRun {
  readonly head: RunHead;
  readonly report: RunReport | null;
  /** Why there is no report. */
  readonly failure: string | null;
  readonly on_map: RunOnMap;
}

export class Runs {
  items = $state.raw<readonly RunHead[]>([]);
  next_cursor = $state.raw<string | null>(null);
  loading = $state(false);
  failure = $state<string | null>(null);
  first = $state.raw<OpenRun | null>(null);
  second = $state.raw<OpenRun | null>(null);
  on_map = $derived<readonly RunOnMap[]>(
    [this.first, this.second].flatMap((run) => (run ? [run.on_map] : [])),
  );

  readonly #calls: RunCalls;

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
    this.first = await this.#read(head);
    this.loading = false;
    return this.first.on_map.lines.flat();
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
  }

  track_address(id: number, format: 'csv' | 'gpx' | 'geojson'): string {
    return this.#calls.track_address(id, format);
  }

  async #read(head: RunHead): Promise<OpenRun> {
    const [report, track, plan] = await Promise.all([
      this.#calls.report(head.id),
      this.#calls.track(head.id),
      this.#calls.plan(head.id),
    ]);
    return {
      head,
      report: report.ok ? report.value : null,
      failure: report.ok ? null : refusal_text(report.refusal),
      on_map: {
        lines: track.ok ? track.value : [],
        planned: plan.ok ? spots(plan.value) : [],
      },
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
