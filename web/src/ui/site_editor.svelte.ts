// A map that is changed a little by hand: areas are drawn, may be taken back, and are saved together.

import { failure_text, refusal_text } from '../model/answer';
import { begin_history, perform, undo, type History } from '../model/history';
import { plan_of_places, type Places } from '../model/outline';
import type { LatLon, Plan } from '../model/plan';
import type { MapMode } from '../model/ports';
import { say } from '../model/say';
import type { Placed } from '../model/seen';
import {
  add_edit,
  allow,
  change_of,
  change_ring,
  changes_map,
  place_of_map,
  remove_edit,
  why_not_save,
  type EditKind,
  type SiteDraft,
  type SiteEdit,
  type SiteMap,
  type SiteMapCalls,
} from '../model/site_map';
import type { Dialogs } from './dialogs.svelte';
import { RingDrawing, type Drawing } from './drawing.svelte';
import type { Notices } from './notices.svelte';

/** What the editor asks of the list. */
interface Shelf {
  readonly here: LatLon | null;
  fetch_cells(): Promise<void>;
  refresh(): Promise<void>;
}
const NOTHING: SiteDraft = { edits: [], forbidden: [] };

export class SiteEditor extends RingDrawing implements Drawing {
  /** Null: none is open. */
  map = $state.raw<SiteMap | null>(null);
  /** Where it is drawn, and stays as long as one draws on it. */
  at = $state.raw<Placed | null>(null);
  busy = $state(false);
  #history = $state.raw<History<SiteDraft>>(begin_history(NOTHING));
  draft = $derived<SiteDraft>(this.#history.present);
  edits = $derived<readonly SiteEdit[]>(this.draft.edits);
  can_undo = $derived(this.#history.past.length > 0);
  why_not = $derived<string | null>(this.map && why_not_save(this.draft, this.map));
  /** The area that a hand on the map changes. */
  part = $state<number | null>(null);

  places = $derived<Places>(this.part === null ? [] : (this.edits[this.part]?.ring ?? []));
  plan = $derived<Plan>(plan_of_places(this.places));
  readonly shape = 'ring';
  map_mode = $derived<MapMode>(this.part === null ? 'edit' : 'draw');

  readonly #shelf: Shelf;
  readonly #calls: SiteMapCalls;
  readonly #notices: Notices;
  readonly #dialogs: Dialogs;

  constructor(shelf: Shelf, calls: SiteMapCalls, notices: Notices, dialogs: Dialogs) {
    super();
    this.#shelf = shelf;
    this.#calls = calls;
    this.#notices = notices;
    this.#dialogs = dialogs;
  }

  open(map: SiteMap): void {
    const at = place_of_map(map, this.#shelf.here);
    if (!at) {
      this.#notices.show('warning', say('neither_the_map_nor_the_robot_has_a'));
      return;
    }
    this.at = at;
    this.#begin(map);
    void this.#shelf.fetch_cells();
    void this.#read_forbidden(map.id);
  }

  async close(): Promise<void> {
    if (this.map && changes_map(this.draft, this.map)) {
      const sure = await this.#dialogs.ask({
        title: say('discard_what_was_drawn'),
        text: say('the_changes_of_value_are_not_saved', { value: this.map?.name ?? '' }),
        yes: say('discard'),
        danger: true,
      });
      if (!sure) return;
    }
    this.at = null;
    this.#begin(null);
    void this.#shelf.fetch_cells();
  }

  add_area(kind: EditKind): void {
    this.#do(add_edit(kind));
    this.choose(this.edits.length - 1);
  }

  remove_area(index: number): void {
    this.#do(remove_edit(index));
    this.choose(null);
  }

  allow_area(index: number): void {
    this.#do(allow(index));
  }

  choose(part: number | null): void {
    this.part = part;
    this.selected = null;
  }

  undo(): void {
    this.#history = undo(this.#history);
    // The area may have been added by what is undone.
    const gone = this.part !== null && !this.edits[this.part];
    this.choose(gone ? null : this.part);
  }

  async save(): Promise<void> {
    const { map, at } = this;
    if (!map || !at || this.busy || this.why_not !== null) return;
    const sent = this.draft;
    const change = change_of(sent, map, at);
    this.busy = true;
    const answer = await this.#calls.change(map.id, change);
    this.busy = false;
    if (!answer.ok) {
      this.#notices.show(
        'error',
        say('the_map_refusal', { refusal: failure_text(say('done_saved'), answer.refusal) }),
      );
      if (answer.refusal.status === 409 && change.revision) await this.#see_anew(map.id);
      return;
    }
    this.#notices.show('good', say('saved_the_map_name', { name: answer.value.name }));
    // Meanwhile the editor may have been closed, or more been drawn.
    if (this.map?.id === map.id && this.at) this.#go_on(answer.value, sent);
    await this.#shelf.refresh();
  }

  /** What was drawn after it was sent stays, and waits to be saved. */
  #go_on(map: SiteMap, sent: SiteDraft): void {
    const more = this.draft;
    const in_hand = this.part === null ? undefined : more.edits[this.part];
    this.#begin(map);
    if (more === sent) return;
    const drawn_since = more.edits.filter((edit) => !sent.edits.includes(edit));
    this.#do((draft) => ({ ...draft, edits: drawn_since }));
    if (in_hand && drawn_since.includes(in_hand)) this.choose(drawn_since.indexOf(in_hand));
  }

  /** Another one changed what is forbidden: that is shown, and what was drawn stays. */
  async #see_anew(id: number): Promise<void> {
    const answer = await this.#calls.read(id);
    if (!answer.ok || this.map?.id !== id) return;
    const { edits } = this.draft;
    this.#begin(answer.value);
    if (edits.length > 0) this.#do((draft) => ({ ...draft, edits }));
    await this.#shelf.refresh();
  }

  #begin(map: SiteMap | null): void {
    this.map = map;
    this.#history = begin_history({ edits: [], forbidden: map?.forbidden ?? [] });
    this.choose(null);
  }

  /** The list does not tell it. */
  async #read_forbidden(id: number): Promise<void> {
    const answer = await this.#calls.read(id);
    if (answer.ok && this.map?.id === id && !this.can_undo) this.#begin(answer.value);
    else if (!answer.ok) this.#notices.show('error', refusal_text(answer.refusal));
  }

  protected change(action: (ring: Places) => Places): void {
    if (this.part !== null) this.#do(change_ring(this.part, action));
  }

  #do(action: (draft: SiteDraft) => SiteDraft): void {
    this.#history = perform(this.#history, action);
  }
}
