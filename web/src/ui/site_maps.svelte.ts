// The maps of places: the list, the one that is in use, and the cells that are drawn of one.

import { untrack } from 'svelte';

import { failure_text, refusal_text, type Answer } from '../model/answer';
import type { PlanMap } from '../model/map_plan';
import type { LatLon } from '../model/plan';
import { say } from '../model/say';
import {
  name_of_files,
  pair_of,
  place_of_map,
  type MapAnchor,
  type MapFiles,
  type SiteMaking,
  type SiteMap,
  type SiteMapCalls,
  type SiteOnMap,
} from '../model/site_map';
import { robot_place } from '../model/vehicle';
import { for_robot } from '../ortho/map_picture';
import type { Dialogs } from './dialogs.svelte';
import type { Live } from './live.svelte';
import type { Notices } from './notices.svelte';
import { SiteCells } from './site_cells.svelte';
import { SiteEditor } from './site_editor.svelte';

/** Where the map lies may be found out any time, and others change maps too. */
const RENEWED_MS = 10_000;
/** While one is being driven. */
const MAKING_RENEWED_MS = 2_000;

export class SiteMaps {
  items = $state.raw<readonly SiteMap[]>([]);
  #list_failure = $state<string | null>(null);
  failure = $derived.by<string | null>(() => this.#list_failure ?? this.#cells.failure);
  /** What is being done to a map; null: nothing. */
  busy = $state<string | null>(null);
  #listed = $state(false);
  /** What is being driven; null: nothing is. */
  making = $state.raw<SiteMaking | null>(null);
  /** What is sent, and how much of it, from 0 to 1; null: nothing is. */
  sending = $state.raw<{ readonly name: string; readonly share: number } | null>(null);

  readonly editor: SiteEditor;
  in_use = $derived<SiteMap | null>(this.items.find((map) => map.in_use) ?? null);
  #edited = $derived.by<SiteMap | null>(() => (this.#listed ? this.editor.map : null));
  /** Of the mission that is planned; null: it counts from none. */
  #planned = $state.raw<PlanMap | null>(null);
  /** In the list: a map that lies somewhere and is not in use. */
  #looked = $state<number | null>(null);
  /** What is drawn: the map that is edited or looked at, else that of the plan, else the one in use. */
  drawn = $derived.by<SiteMap | null>(() => {
    const map = this.#edited;
    if (map) return this.items.find(({ id }) => id === map.id) ?? map;
    const looked = this.#listed ? this.items.find(({ id }) => id === this.#looked) : undefined;
    return looked ?? this.#planned?.map ?? this.in_use;
  });
  on_map = $derived.by<SiteOnMap | null>(() => {
    const { drawn } = this;
    const cells = drawn && this.#cells.of(drawn);
    if (!drawn || !cells) return null;
    const planned = this.#planned?.map === drawn ? this.#planned.at : null;
    const at = this.#edited ? this.editor.at : (planned ?? place_of_map(drawn, null));
    return at && { map: drawn, cells, at };
  });

  readonly #calls: SiteMapCalls;
  readonly #cells: SiteCells;
  readonly #live: Live;
  readonly #notices: Notices;
  readonly #dialogs: Dialogs;
  /** The map is drawn, not only known by its name. */
  #draws = false;
  /** Of two answers the later question's counts. */
  #question = 0;
  #waits = 0;

  constructor(calls: SiteMapCalls, live: Live, notices: Notices, dialogs: Dialogs) {
    this.#calls = calls;
    this.#cells = new SiteCells(calls);
    this.#live = live;
    this.#notices = notices;
    this.#dialogs = dialogs;
    this.editor = new SiteEditor(this, calls, notices, dialogs);
  }

  /** What is changed in the list is drawn only while one looks at it: the robot does not drive by it. */
  look(listed: boolean): void {
    this.#listed = listed;
    if (!listed) this.#looked = null;
    untrack(() => void this.fetch_cells());
  }

  /** Draws one of the list, as long as one looks at that. */
  show(map: SiteMap): void {
    this.#looked = map.id;
    void this.fetch_cells();
  }

  /** Draws the map that is planned in. @param by null: none is */
  plan_in(by: PlanMap | null): void {
    this.#planned = by;
    void this.fetch_cells();
  }

  /** Asks now and then, as long as it is looked at. @param draws also for cells @return ends it */
  watch(draws: boolean): () => void {
    const again = setInterval(() => {
      if (this.#waits === 0) void this.refresh(); // a slow answer is not overtaken by the next question
    }, RENEWED_MS);
    const sooner = setInterval(() => {
      if (this.#listed && this.making && this.busy === null && this.#waits === 0)
        void this.refresh();
    }, MAKING_RENEWED_MS);
    this.#draws = draws;
    void this.refresh();
    return () => {
      clearInterval(again);
      clearInterval(sooner);
      this.#draws = false;
      void this.fetch_cells();
    };
  }

  async refresh(): Promise<void> {
    const question = (this.#question += 1);
    this.#waits += 1;
    const answer = await this.#calls.list();
    this.#waits -= 1;
    if (question !== this.#question) return;
    this.#list_failure = answer.ok ? null : refusal_text(answer.refusal);
    if (answer.ok) ({ items: this.items, making: this.making } = answer.value);
    void this.fetch_cells();
  }

  async fetch_cells(): Promise<void> {
    await this.#cells.want(this.#draws ? this.drawn : null);
  }

  /** Where a map is drawn that lies nowhere yet. */
  get here(): LatLon | null {
    return robot_place(this.#live.vehicle) ?? this.#live.vehicle?.home ?? null;
  }

  file_address(id: number, format: 'yaml' | 'pgm' | 'pcd'): string {
    return this.#calls.file_address(id, format);
  }

  async add(files: readonly File[]): Promise<void> {
    const pair = pair_of(files);
    if (typeof pair === 'string') this.#notices.show('warning', pair);
    else await this.#send(pair);
  }

  async #send(pair: MapFiles): Promise<void> {
    if (this.sending) {
      this.#notices.show('warning', say('name_is_still_being_sent', { name: this.sending.name }));
      return;
    }
    const name = name_of_files(pair);
    this.sending = { name, share: 0 };
    const files = await for_robot(pair);
    if (typeof files === 'string') {
      this.sending = null;
      this.#notices.outcome(`map ${name}`, `“${name}”: ${files}`);
      return;
    }
    // The files name it, in an exported one by what stands in it; one that is taken gets a number.
    const answer = await this.#calls.add(files, (share) => (this.sending = { name, share }));
    this.sending = null;
    this.#notices.outcome(
      `map ${name}`,
      answer.ok ? null : `“${name}”: ${failure_text(say('done_stored'), answer.refusal)}`,
    );
    if (answer.ok) {
      const { name: called, passed_over = [] } = answer.value;
      this.#notices.show('good', say('the_map_name_is_stored', { name: called }));
      // Of a yaml it is words that say nothing here; of a cloud parts of the place.
      if ('cloud' in pair && passed_over.length > 0) {
        const what = passed_over.join('; ');
        this.#notices.show('warning', say('left_out_of_the_map_name', { name: called, what }));
      }
    }
    await this.refresh();
  }

  /** @return false: it has its old name */
  async rename(map: SiteMap, name: string): Promise<boolean> {
    const wanted = name.trim();
    if (wanted === map.name) return true;
    if (wanted === '') return false;
    return this.#do(say('done_renamed'), () => this.#calls.change(map.id, { name: wanted }));
  }

  /** @param anchor null: nobody knows where it lies */
  async lay(map: SiteMap, anchor: MapAnchor | null): Promise<void> {
    if (!(await this.#do(say('laid_there'), () => this.#calls.change(map.id, { anchor })))) return;
    const { name } = map;
    const said = anchor
      ? say('map_laid', { name, change: say('change') })
      : say('map_laid_nowhere', { name });
    this.#notices.show('good', said, 'map laid');
  }

  async remove(map: SiteMap): Promise<void> {
    const sure = await this.#dialogs.ask({
      title: say('delete_the_map'),
      text: say('name_goes_for_good_with_what_was', { name: map.name }),
      yes: say('delete_it'),
      danger: true,
    });
    if (sure) await this.#do(say('done_deleted'), () => this.#calls.remove(map.id));
  }

  /** @param map null: none */
  async use(map: SiteMap | null): Promise<void> {
    if (map === null) {
      const sure = await this.#dialogs.ask({
        title: say('without_a_map'),
        text: say('the_robot_no_longer_finds_its_place'),
        yes: say('without_a_map_2'),
        danger: true,
      });
      if (!sure) return;
    }
    await this.#do(map ? say('taken_into_use') : say('put_away'), () =>
      this.#calls.use(map?.id ?? null),
    );
  }

  async start_making(): Promise<void> {
    await this.#do(say('done_begun'), () => this.#calls.start_making());
  }

  /** @return whether it is kept */
  async finish_making(name: string): Promise<boolean> {
    let kept: SiteMap | null = null;
    await this.#do(say('done_kept'), async () => {
      const answer = await this.#calls.finish_making(name);
      if (answer.ok) kept = answer.value;
      return answer;
    });
    if (kept)
      this.#notices.show('good', say('the_map_name_is_stored', { name: (kept as SiteMap).name }));
    return kept !== null;
  }

  async drop_making(): Promise<void> {
    const sure = await this.#dialogs.ask({
      title: say('drop_what_was_driven'),
      text: say('what_the_scanner_saw_on_this_drive'),
      yes: say('drop_it'),
      danger: true,
    });
    if (sure) await this.#do(say('done_dropped'), () => this.#calls.drop_making());
  }

  /** One at a time; another one is not done, and not in silence. */
  async #do(done: string, call: () => Promise<Answer<unknown>>): Promise<boolean> {
    if (this.busy !== null) {
      this.#notices.show(
        'warning',
        say('the_map_was_not_done_one_is_still', { done, busy: this.busy }),
      );
      return false;
    }
    this.busy = done;
    const answer = await call();
    this.busy = null;
    this.#notices.outcome(
      `map ${done}`,
      answer.ok ? null : say('the_map_done', { done: failure_text(done, answer.refusal) }),
    );
    await this.refresh();
    return answer.ok;
  }
}
