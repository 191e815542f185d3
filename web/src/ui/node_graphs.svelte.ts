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
} from '../model/node_graph';
import { say } from '../model/say';
import type { Station } from './station.svelte';

export class NodeGraphs {
  /** Null: not read yet. */
  items = $state.raw<readonly NodeGraph[] | null>(null);
  /** Null: none is looked at. */
  shown = $state.raw<NodeGraphWithNodes | null>(null);
  busy = $state(false);
  failure = $state<string | null>(null);
  /** Of the one that was just added. */
  notes = $state.raw<readonly GraphNote[]>([]);
  on_map = $derived.by<GraphOnMap | null>(() =>
    this.shown ? graph_on_map(this.shown, this.#station.in_map.by) : null,
  );

  readonly #calls: NodeGraphCalls;
  readonly #station: Station;

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
    if (id !== null) await this.#read(id);
  }

  async add(file: File, map: string): Promise<void> {
    this.busy = true;
    const answer = await this.#calls.add(file, map);
    this.busy = false;
    if (!answer.ok) {
      this.failure = refusal_text(answer.refusal);
      return;
    }
    await this.refresh();
    await this.#read(answer.value.id);
    this.notes = answer.value.notes;
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

  /** The way goes behind what is planned already. @param from null: where the robot is */
  async plan(from: number | null, to: number): Promise<void> {
    if (!this.shown) return;
    this.busy = true;
    const answer = await this.#calls.plan({ graph: this.shown.id, from, to });
    this.busy = false;
    this.failure = answer.ok ? null : refusal_text(answer.refusal);
    if (answer.ok) this.#station.editor.do(append_way(answer.value));
  }

  async #read(id: string): Promise<void> {
    this.busy = true;
    const answer = await this.#calls.read(id);
    this.busy = false;
    this.failure = answer.ok ? null : refusal_text(answer.refusal);
    if (answer.ok) this.shown = answer.value;
  }
}
