// The drill: asked for, looked at while it runs, and one of its failures chosen. The robot itself
// has no part in it.

import { refusal_text } from '../model/answer';
import { drill_on_map, type Drill, type DrillOnMap } from '../model/drill';
import { distance_m } from '../model/geo';
import { spots, type Plan } from '../model/plan';
import type { DrillCalls } from '../model/ports';

const ASK_AGAIN_MS = 700;
const MIDDLE = 50;

export interface DrillSubject {
  readonly id: string;
  readonly revision: number;
  readonly name: string;
  readonly plan: Plan;
  readonly loaded: boolean;
}

export class Drills {
  open = $state(false);
  last = $state.raw<Drill | null>(null);
  failure = $state<string | null>(null);
  busy = $state(false);
  /** Where on the way it fails, per cent. */
  share = $state(MIDDLE);
  /** Failures that are not wanted. */
  left_out = $state.raw<ReadonlySet<string>>(new Set());
  /** The one that is looked at. */
  chosen = $state<string | null>(null);
  on_map = $derived.by<DrillOnMap | null>(() =>
    this.open && this.last ? drill_on_map(this.last, this.chosen) : null,
  );
  running = $derived(this.last?.state === 'running');

  readonly #calls: DrillCalls;
  #timer: ReturnType<typeof setTimeout> | undefined;

  constructor(calls: DrillCalls) {
    this.#calls = calls;
  }

  async show(): Promise<void> {
    this.open = true;
    this.chosen = null;
    await this.refresh();
  }

  close(): void {
    clearTimeout(this.#timer);
    this.open = false;
  }

  toggle(id: string): void {
    const next = new Set(this.left_out);
    if (!next.delete(id)) next.add(id);
    this.left_out = next;
  }

  /** How far along its way that is; the way is known exactly once a drill has laid it out. */
  at_m(subject: DrillSubject): number {
    const { last } = this;
    const known =
      last?.begins && last.mission?.id === subject.id && last.mission.revision === subject.revision
        ? last.begins.length_m
        : 0.99 * line_m(subject.plan);
    return (this.share / 100) * known;
  }

  async begin(subject: DrillSubject): Promise<void> {
    const all = this.last?.failures.map(({ id }) => id) ?? [];
    const wanted = all.filter((id) => !this.left_out.has(id));
    this.busy = true;
    this.chosen = null;
    const answer = await this.#calls.begin({
      ...(subject.loaded ? {} : { mission: { id: subject.id, revision: subject.revision } }),
      ...(this.share === MIDDLE ? {} : { at_m: this.at_m(subject) }),
      ...(this.left_out.size > 0 ? { failures: wanted } : {}),
    });
    this.busy = false;
    this.failure = answer.ok ? null : refusal_text(answer.refusal);
    if (answer.ok) this.#take(answer.value);
  }

  async cancel(): Promise<void> {
    const answer = await this.#calls.cancel();
    if (answer.ok) this.#take(answer.value);
    else await this.refresh(); // it may have ended by itself
  }

  async refresh(): Promise<void> {
    const answer = await this.#calls.read();
    this.failure = answer.ok ? null : refusal_text(answer.refusal);
    if (answer.ok) this.#take(answer.value);
    else if (this.running) this.#ask_again();
  }

  #take(drill: Drill): void {
    this.last = drill;
    if (drill.state === 'running') this.#ask_again();
  }

  #ask_again(): void {
    clearTimeout(this.#timer);
    if (this.open) this.#timer = setTimeout(() => void this.refresh(), ASK_AGAIN_MS);
  }
}

const line_m = (plan: Plan): number => {
  const points = spots(plan);
  return points.reduce((sum, point, k) => {
    const before = points[k - 1];
    return before ? sum + distance_m(before, point) : sum;
  }, 0);
};
