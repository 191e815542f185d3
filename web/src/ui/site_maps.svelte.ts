// The maps of places: the list, the one that is in use, and the cells that are drawn of one.

import { untrack } from 'svelte';

import { failure_text, refusal_text, type Answer } from '../model/answer';
import type { LatLon } from '../model/plan';
import {
  pair_of,
  place_of_map,
  type MapAnchor,
  type MapFiles,
  type SiteMap,
  type SiteMapCalls,
  type SiteOnMap,
  type TaggedCells,
} from '../model/site_map';
import { robot_place } from '../model/vehicle';
import type { Dialogs } from './dialogs.svelte';
import type { Live } from './live.svelte';
import type { Notices } from './notices.svelte';
import { SiteEditor } from './site_editor.svelte';

/** Where the map lies may be found out any time, and others change maps too. */
const RENEWED_MS = 10_000;
const KEPT = 2;

interface KnownCells {
  readonly id: number;
  readonly revision: number;
  readonly cells: TaggedCells;
}

export class SiteMaps {
  items = $state.raw<readonly SiteMap[]>([]);
  failure = $state<string | null>(null);
  busy = $state(false);
  #listed = $state(false);
  /** What is sent, and how much of it, from 0 to 1; null: nothing is. */
  sending = $state.raw<{ readonly name: string; readonly share: number } | null>(null);
  /** Of the map in use and of the one that is edited. */
  #known = $state.raw<readonly KnownCells[]>([]);

  readonly editor: SiteEditor;
  in_use = $derived<SiteMap | null>(this.items.find((map) => map.in_use) ?? null);
  #edited = $derived.by<SiteMap | null>(() => (this.#listed ? this.editor.map : null));
  /** What is drawn: the map that is edited, else the one in use. */
  drawn = $derived.by<SiteMap | null>(() => {
    const map = this.#edited;
    if (map) return this.items.find(({ id }) => id === map.id) ?? map;
    return this.in_use;
  });
  on_map = $derived.by<SiteOnMap | null>(() => {
    const { drawn } = this;
    const known = drawn && this.#known_of(drawn);
    if (!drawn || !known) return null;
    const at = this.#edited ? this.editor.at : place_of_map(drawn, null);
    return at && { map: drawn, cells: known.cells, at };
  });

  readonly #calls: SiteMapCalls;
  readonly #live: Live;
  readonly #notices: Notices;
  readonly #dialogs: Dialogs;
  /** Of two answers the later question's counts. */
  #question = 0;

  constructor(calls: SiteMapCalls, live: Live, notices: Notices, dialogs: Dialogs) {
    this.#calls = calls;
    this.#live = live;
    this.#notices = notices;
    this.#dialogs = dialogs;
    this.editor = new SiteEditor(this, calls, notices, dialogs);
  }

  /** What is changed in the list is drawn only while one looks at it: the robot does not drive by it. */
  look(listed: boolean): void {
    this.#listed = listed;
    untrack(() => void this.fetch_cells());
  }

  /** Asks now and then, as long as it is looked at. @return ends it */
  watch(): () => void {
    const again = setInterval(() => void this.refresh(), RENEWED_MS);
    void this.refresh();
    return () => clearInterval(again);
  }

  async refresh(): Promise<void> {
    const answer = await this.#calls.list();
    this.failure = answer.ok ? null : refusal_text(answer.refusal);
    if (answer.ok) this.items = answer.value.items;
    await this.fetch_cells();
  }

  /** Only what is not known yet comes over the link. */
  async fetch_cells(): Promise<void> {
    const { drawn } = this;
    const known = drawn && this.#known_of(drawn);
    if (!drawn || known?.revision === drawn.revision) return;
    const { id, revision } = drawn;
    const question = (this.#question += 1);
    const answer = await this.#calls.cells(id, known?.cells.tag ?? null);
    if (question !== this.#question) return;
    if (!answer.ok) {
      this.failure = `The map is not drawn: ${refusal_text(answer.refusal)}`;
      return;
    }
    const cells = answer.value ?? known?.cells;
    const others = this.#known.filter((other) => other.id !== id);
    if (cells) this.#known = [{ id, revision, cells }, ...others].slice(0, KEPT);
  }

  #known_of(map: SiteMap): KnownCells | null {
    return this.#known.find(({ id }) => id === map.id) ?? null;
  }

  /** Where a map is drawn that lies nowhere yet. */
  get here(): LatLon | null {
    return robot_place(this.#live.vehicle) ?? this.#live.vehicle?.home ?? null;
  }

  file_address(id: number, format: 'yaml' | 'pgm'): string {
    return this.#calls.file_address(id, format);
  }

  async add(files: readonly File[]): Promise<void> {
    const pair = pair_of(files);
    if (typeof pair === 'string') this.#notices.show('warning', pair);
    else await this.#send(pair);
  }

  async #send(pair: MapFiles): Promise<void> {
    if (this.sending) {
      this.#notices.show('warning', `“${this.sending.name}” is still being sent.`);
      return;
    }
    const name = pair.yaml.name.replace(/\.ya?ml$/i, '');
    this.sending = { name, share: 0 };
    const answer = await this.#calls.add(pair, name, (share) => (this.sending = { name, share }));
    this.sending = null;
    if (answer.ok) this.#notices.show('good', `The map “${answer.value.name}” is stored.`);
    else this.#notices.show('error', `“${name}”: ${failure_text('stored', answer.refusal)}`);
    await this.refresh();
  }

  async rename(map: SiteMap, name: string): Promise<void> {
    const wanted = name.trim();
    if (wanted === '' || wanted === map.name) return;
    await this.#do('renamed', () => this.#calls.change(map.id, { name: wanted }));
  }

  /** @param anchor null: nobody knows where it lies */
  async lay(map: SiteMap, anchor: MapAnchor | null): Promise<void> {
    await this.#do('laid there', () => this.#calls.change(map.id, { anchor }));
  }

  async remove(map: SiteMap): Promise<void> {
    const sure = await this.#dialogs.ask({
      title: 'Delete the map?',
      text: `“${map.name}” goes for good, with what was changed in it by hand.`,
      yes: 'Delete',
      danger: true,
    });
    if (sure) await this.#do('deleted', () => this.#calls.remove(map.id));
  }

  /** @param map null: none */
  async use(map: SiteMap | null): Promise<void> {
    if (map === null) {
      const sure = await this.#dialogs.ask({
        title: 'Without a map?',
        text: 'The robot no longer finds its place by what it sees: without satellites it soon does not know where it is.',
        yes: 'Without a map',
        danger: true,
      });
      if (!sure) return;
    }
    await this.#do(map ? 'taken into use' : 'put away', () => this.#calls.use(map?.id ?? null));
  }

  async #do(failed: string, call: () => Promise<Answer<unknown>>): Promise<void> {
    if (this.busy) return;
    this.busy = true;
    const answer = await call();
    this.busy = false;
    if (!answer.ok) this.#notices.show('error', `The map: ${failure_text(failed, answer.refusal)}`);
    await this.refresh();
  }
}
