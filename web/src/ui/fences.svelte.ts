// Fences: the list, the one that the robot keeps to, and the one that is drawn.

import { failure_text, refusal_text, type Answer } from '../model/answer';
import {
  area_places,
  fresh_circle,
  NEW_FENCE,
  with_places,
  type AreaKind,
  type Fence,
  type FenceDraft,
  type FenceSummary,
} from '../model/fence';
import { begin_history, perform, undo, type History } from '../model/history';
import { plan_of_places, type Places } from '../model/outline';
import type { LatLon, Plan } from '../model/plan';
import type { FenceCalls, MapMode, PlanShape } from '../model/ports';
import { say } from '../model/say';
import type { Dialogs } from './dialogs.svelte';
import { RingDrawing, type Drawing } from './drawing.svelte';
import type { Notices } from './notices.svelte';

/** The area that a hand on the map changes, or the rally points. */
export type Part = number | 'rally' | null;

/** Whether the fence that was saved holds the robot. */
const IN_FORCE = 'fence in force';

export class Fences extends RingDrawing implements Drawing {
  items = $state.raw<readonly FenceSummary[]>([]);
  failure = $state<string | null>(null);
  /** What the robot keeps to. */
  active = $state.raw<Fence | null>(null);
  #history = $state.raw<History<FenceDraft | null>>(begin_history<FenceDraft | null>(null));
  /** What is drawn now. */
  draft = $derived<FenceDraft | null>(this.#history.present);
  can_undo = $derived(this.#history.past.length > 0);
  part = $state<Part>(null);
  busy = $state(false);
  #stored = $state.raw<Fence | null>(null);
  unsaved = $derived(this.draft !== null && this.draft !== this.#stored);

  places = $derived<Places>(this.#places());
  plan = $derived<Plan>(plan_of_places(this.places));
  shape = $derived<PlanShape>(this.#circle ? 'points' : this.part === 'rally' ? 'points' : 'ring');
  map_mode = $derived<MapMode>(this.part === null ? 'edit' : 'draw');

  readonly #calls: FenceCalls;
  readonly #notices: Notices;
  readonly #dialogs: Dialogs;

  constructor(calls: FenceCalls, notices: Notices, dialogs: Dialogs) {
    super();
    this.#calls = calls;
    this.#notices = notices;
    this.#dialogs = dialogs;
  }

  async refresh(): Promise<void> {
    const answer = await this.#calls.list();
    if (answer.ok) this.items = answer.value.items;
    this.failure = answer.ok ? null : refusal_text(answer.refusal);
    await this.refresh_active();
  }

  async refresh_active(): Promise<void> {
    const answer = await this.#calls.active();
    if (answer.ok) this.active = answer.value;
  }

  begin(): void {
    this.#show(NEW_FENCE, null);
  }

  /** @return its places, to be shown on the map */
  async open(id: string): Promise<readonly LatLon[]> {
    const answer = await this.#calls.read(id);
    this.#tell(say('done_opened'), id, answer);
    if (!answer.ok) return [];
    this.#show(answer.value, answer.value);
    return [...answer.value.areas.flatMap(area_places), ...answer.value.rally];
  }

  async close(): Promise<void> {
    if (this.unsaved) {
      const sure = await this.#dialogs.ask({
        title: say('discard_unsaved_changes'),
        text: say('value_has_changes_that_are_not_saved', { value: this.draft?.name ?? '' }),
        yes: say('discard'),
        danger: true,
      });
      if (!sure) return;
    }
    this.#history = begin_history<FenceDraft | null>(null);
    this.part = null;
    this.selected = null;
  }

  rename(name: string): void {
    if (this.draft) this.#edit({ ...this.draft, name });
  }

  /** @param at the middle of a circle; null: corners are tapped one by one */
  add_area(kind: AreaKind, at: LatLon | null): void {
    if (!this.draft) return;
    const area = at ? fresh_circle(kind, at) : { kind, polygon: [] };
    this.#edit({ ...this.draft, areas: [...this.draft.areas, area] });
    this.choose(this.draft.areas.length - 1);
  }

  remove_area(index: number): void {
    if (!this.draft) return;
    this.#edit({ ...this.draft, areas: this.draft.areas.filter((_, k) => k !== index) });
    this.choose(null);
  }

  set_radius(index: number, radius_m: number): void {
    if (!this.draft) return;
    const areas = this.draft.areas.map((area, k) =>
      k === index && area.circle ? { kind: area.kind, circle: { ...area.circle, radius_m } } : area,
    );
    this.#edit({ ...this.draft, areas });
  }

  choose(part: Part): void {
    this.part = part;
    this.selected = null;
  }

  /** The middle of a circle is its only place. */
  override add(at: LatLon): void {
    if (!this.#circle) return super.add(at);
    this.change(() => [at]);
    this.selected = null;
  }

  override remove_selected(): void {
    if (!this.#circle) return super.remove_selected();
    this.selected = null;
  }

  undo(): void {
    if (!this.draft) return;
    this.#history = undo(this.#history);
    const part = this.part;
    // The area may have been added by what is undone.
    const gone = typeof part === 'number' && !this.draft.areas[part];
    this.choose(gone ? null : part);
  }

  async save(): Promise<void> {
    const { draft } = this;
    const stored = this.#stored;
    if (!draft) return;
    let kept: Fence | null = null;
    await this.#do(say('done_saved'), stored?.id ?? '', async () => {
      const answer = stored
        ? await this.#calls.replace(stored.id, stored.revision, draft)
        : await this.#calls.create(draft);
      if (answer.ok) this.#show(answer.value, (kept = answer.value));
      return answer;
    });
    if (kept) this.#tell_saved(kept);
  }

  #tell_saved({ id, name }: Fence): void {
    const saved = say('saved_the_fence_name', { name });
    if (this.active?.id === id) this.#notices.show('good', saved, IN_FORCE);
    else {
      const not_in_force = say('it_is_not_kept_to', { use: say('use_it') });
      this.#notices.show('warning', `${saved} ${not_in_force}`, IN_FORCE);
    }
  }

  /** @param fence null: the robot keeps to none */
  async use(fence: FenceSummary | null): Promise<void> {
    if (fence === null) {
      const sure = await this.#dialogs.ask({
        title: say('without_a_fence'),
        text: say('nothing_keeps_the_robot_inside_any'),
        yes: say('without_a_fence_2'),
        danger: true,
      });
      if (!sure) return;
    }
    await this.#activate(fence?.id ?? null);
  }

  /** One that came with a mission. @return whether the robot keeps to it now */
  async use_imported(id: string): Promise<boolean> {
    await this.#activate(id);
    return this.active?.id === id;
  }

  async #activate(id: string | null): Promise<void> {
    await this.#do(say('done_changed'), 'which', () => this.#calls.activate(id));
    // What was said of one that was saved holds no longer.
    if ((this.active?.id ?? null) === id) this.#notices.outcome(IN_FORCE, null);
  }

  async remove(fence: FenceSummary): Promise<void> {
    const sure = await this.#dialogs.ask({
      title: say('delete_fence'),
      text: say('name_will_be_deleted', { name: fence.name }),
      yes: say('delete_it'),
      danger: true,
    });
    if (sure)
      await this.#do(say('done_deleted'), fence.id, () =>
        this.#calls.remove(fence.id, fence.revision),
      );
  }

  get #circle(): boolean {
    return typeof this.part === 'number' && this.draft?.areas[this.part]?.circle !== undefined;
  }

  #places(): Places {
    if (this.part === 'rally') return this.draft?.rally ?? [];
    const area = this.part === null ? undefined : this.draft?.areas[this.part];
    return area ? area_places(area) : [];
  }

  protected change(action: (places: Places) => Places): void {
    const { draft, part } = this;
    if (!draft || part === null) return;
    const places = action(this.places);
    if (part === 'rally') {
      this.#edit({ ...draft, rally: places });
      return;
    }
    const areas = draft.areas.map((area, k) => (k === part ? with_places(area, places) : area));
    this.#edit({ ...draft, areas });
  }

  #show(draft: FenceDraft, stored: Fence | null): void {
    this.#history = begin_history<FenceDraft | null>(draft);
    this.#stored = stored;
    this.part = null;
    this.selected = null;
  }

  #edit(draft: FenceDraft): void {
    this.#history = perform(this.#history, () => draft);
  }

  async #do(failed: string, of: string, call: () => Promise<Answer<unknown>>): Promise<void> {
    if (this.busy) return;
    this.busy = true;
    const answer = await call();
    this.busy = false;
    this.#tell(failed, of, answer);
    await this.refresh();
  }

  #tell(failed: string, of: string, answer: Answer<unknown>): void {
    this.#notices.outcome(
      `fence ${failed} ${of}`,
      answer.ok ? null : failure_text(failed, answer.refusal),
    );
  }
}
