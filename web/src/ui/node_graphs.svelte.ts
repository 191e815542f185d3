// The graphs of nodes that the robot keeps: one of them is shown while a mission is planned, and ways
// through it become part of that.

import { refusal_text } from '../model/answer';
import {
  append_way,
  graph_on_map,
  type GraphNote,
  type GraphOnMap,
  type NodeGraph,
  type NodeGraphCalls,
  type NodeGraphWithNodes,
  why_not_way,
} from '../model/node_graph';
import { say } from '../model/say';
import type { Station } from './station.svelte';

export class NodeGraphs {
  /** Null: not read yet. */
  items = $state.raw<readonly NodeGraph[] | null>(null);
  /** Null: none is looked at. */
  shown = $state.raw<NodeGraphWithNodes | null>(null);
  #under_way = $state(0);
  busy = $derived(this.#under_way > 0);
  failure = $state<string | null>(null);
  /** Of the one that was just added. */
  notes = $state.raw<readonly GraphNote[]>([]);
  on_map = $derived.by<GraphOnMap | null>(() =>
    this.shown ? graph_on_map(this.shown, this.#station.in_map.by) : null,
  );

  readonly #calls: NodeGraphCalls;
  readonly #station: Station;
  /** How often one was chosen: an answer to an earlier choice comes too late. */
  #chosen = 0;

  constructor(calls: NodeGraphCalls, station: Station) {
    this.#calls = calls;
    this.#station = station;
  }

  async refresh(): Promise<void> {
    const answer = await this.#calls.all();
    this.failure = answer.ok ? null : refusal_text(answer.refusal);
    if (answer.ok) this.items = answer.value;
    if (this.shown && !this.items?.some(({ id }) => id === this.shown?.id)) this.shown = null;
  }

  /** @param id null: none */
  async show(id: string | null): Promise<void> {
    this.notes = [];
    this.shown = null;
    this.#chosen += 1;
    if (id !== null) await this.#read(id);
  }

  async add(file: File, map: string): Promise<void> {
    const answer = await this.#waited(this.#calls.add(file, map));
    if (!answer.ok) {
      this.failure = refusal_text(answer.refusal);
      return;
    }
    await this.refresh();
    this.notes = answer.value.notes;
    await this.#read(answer.value.id);
  }

  async forget(graph: NodeGraph): Promise<void> {
    const sure = await this.#station.dialogs.ask({
      title: say('graph_forget_name', { name: graph.name }),
      text: say('graph_missions_stay'),
      yes: say('forget_it'),
      danger: true,
    });
    if (!sure) return;
    const answer = await this.#calls.forget(graph.id);
    await this.refresh();
    if (!answer.ok) this.failure = refusal_text(answer.refusal);
  }

  /** The way goes behind what is planned already. If another mission or graph is looked at by the time
   * that it is known, nobody wants it any more. @param from null: where the robot is */
  async plan(from: number | null, to: number): Promise<void> {
    const { shown } = this;
    const { editor } = this.#station;
    const { plan, stored } = editor;
    if (!shown) return;
    const answer = await this.#waited(this.#calls.plan({ graph: shown.id, from, to }));
    // Whoever only stored it has the same mission still.
    const same = editor.stored?.id === stored?.id || editor.plan === plan;
    if (this.shown?.id !== shown.id || !same) return;
    this.failure = answer.ok
      ? why_not_way(shown, { from, to }, editor.plan)
      : refusal_text(answer.refusal);
    if (answer.ok && this.failure === null) editor.do(append_way(answer.value));
  }

  async #read(id: string): Promise<void> {
    const choice = (this.#chosen += 1);
    const answer = await this.#waited(this.#calls.read(id));
    if (choice !== this.#chosen) return;
    this.failure = answer.ok ? null : refusal_text(answer.refusal);
    if (answer.ok) this.shown = answer.value;
  }

  async #waited<T>(answer: Promise<T>): Promise<T> {
    this.#under_way += 1;
    try {
      return await answer;
    } finally {
      this.#under_way -= 1;
    }
  }
}
