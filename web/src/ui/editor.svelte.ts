// The mission being edited: its history, what is stored of it, and the draft on the device.

import { type Answer, failure_text, refusal_text, refused_items } from '../model/answer';
import { append_waypoint, insert_waypoint, move_waypoint, remove_item } from '../model/actions';
import type { PlanAction } from '../model/actions';
import { draft_text, parse_draft, type Stored } from '../model/draft';
import { begin_history, perform, redo, undo, type History } from '../model/history';
import { EMPTY_PLAN, type LatLon, type Plan } from '../model/plan';
import type { DraftStorage, MapMode, Mission, MissionCalls } from '../model/ports';
import type { Drawing } from './drawing.svelte';
import type { Dialogs } from './dialogs.svelte';
import type { Notices } from './notices.svelte';

const DRAFT_AFTER_MS = 300;

export const plan_of = (mission: Mission): Plan => ({
  name: mission.name,
  items: mission.items,
  home: mission.home,
  settings: mission.settings,
});

export class Editor implements Drawing {
  history = $state.raw<History<Plan>>(begin_history(EMPTY_PLAN));
  /** Which revision the plan is based on; null: never saved. */
  stored = $state.raw<Stored | null>(null);
  selected = $state<number | null>(null);
  /** Every tap on the map adds a waypoint. */
  adding = $state(true);
  saving = $state(false);
  refused = $state.raw<ReadonlySet<number>>(new Set());
  #saved_plan = $state.raw<Plan | null>(EMPTY_PLAN);

  plan = $derived(this.history.present);
  unsaved = $derived(this.plan !== this.#saved_plan);
  can_undo = $derived(this.history.past.length > 0);
  can_redo = $derived(this.history.future.length > 0);
  readonly shape = 'line';
  map_mode = $derived<MapMode>(this.adding ? 'draw' : 'edit');

  readonly #calls: MissionCalls;
  readonly #storage: DraftStorage;
  readonly #notices: Notices;
  readonly #dialogs: Dialogs;
  #draft_timer: ReturnType<typeof setTimeout> | undefined;

  constructor(calls: MissionCalls, storage: DraftStorage, notices: Notices, dialogs: Dialogs) {
    this.#calls = calls;
    this.#storage = storage;
    this.#notices = notices;
    this.#dialogs = dialogs;
  }

  do(action: PlanAction): void {
    this.#set_history(perform(this.history, action));
  }

  undo(): void {
    this.#set_history(undo(this.history));
  }

  redo(): void {
    this.#set_history(redo(this.history));
  }

  add(at: LatLon): void {
    this.do(append_waypoint(at));
    this.selected = null;
  }

  select(index: number | null): void {
    this.selected = index;
  }

  insert(index: number, at: LatLon): void {
    this.do(insert_waypoint(index, at));
    this.selected = index;
  }

  move(index: number, to: LatLon): void {
    this.do(move_waypoint(index, to));
    this.selected = index;
  }

  remove_selected(): void {
    if (this.selected !== null) this.remove(this.selected);
  }

  remove(index: number): void {
    this.do(remove_item(index));
    this.selected = null;
  }

  /** An empty plan. What was unsaved is gone, so whoever calls has asked. */
  begin_new(): void {
    this.#begin(EMPTY_PLAN, null);
    this.adding = true;
  }

  show_mission(mission: Mission): void {
    this.#begin(plan_of(mission), { id: mission.id, revision: mission.revision });
    this.adding = mission.items.length === 0;
  }

  /** True when it is safe to replace the plan: nothing unsaved, or the person said so. */
  async may_discard(): Promise<boolean> {
    if (!this.unsaved) return true;
    return this.#dialogs.ask({
      title: 'Discard unsaved changes?',
      text: `“${this.plan.name}” has changes that are not saved.`,
      yes: 'Discard',
      danger: true,
    });
  }

  async save(): Promise<boolean> {
    if (this.saving) return false;
    this.saving = true;
    try {
      const plan = this.plan;
      const answer =
        this.stored === null
          ? await this.#calls.create(plan)
          : await this.#calls.replace(this.stored.id, this.stored.revision, plan);
      return await this.#after_save(plan, answer);
    } finally {
      this.saving = false;
    }
  }

  async #after_save(plan: Plan, answer: Answer<Mission>): Promise<boolean> {
    if (answer.ok) {
      this.stored = { id: answer.value.id, revision: answer.value.revision };
      this.#saved_plan = plan;
      this.refused = new Set();
      this.write_draft();
      this.#notices.show('good', `Saved “${plan.name}”, revision ${answer.value.revision}.`);
      return true;
    }
    const { refusal } = answer;
    if (refusal.status === 412) return this.#settle_conflict(plan, refusal.current ?? null);
    if (refusal.status === 404 && this.stored !== null) return this.#save_as_new(plan);
    this.refused = refused_items(refusal);
    this.#notices.show('error', failure_text('saved', refusal));
    return false;
  }

  /** Somebody deleted it meanwhile: what is on the screen must not be lost. */
  async #save_as_new(plan: Plan): Promise<boolean> {
    this.stored = null;
    this.#notices.show('warning', 'The stored mission was deleted; saving it as a new one.');
    return this.#after_save(plan, await this.#calls.create(plan));
  }

  async #settle_conflict(plan: Plan, current: Mission | null): Promise<boolean> {
    const stored = this.stored;
    if (stored === null) return false;
    const theirs = current ?? (await this.#read(stored.id));
    if (theirs === null) return false;
    const choice = await this.#dialogs.conflict(stored.revision, theirs);
    switch (choice) {
      case 'theirs':
        this.#adopt(theirs);
        return false;
      case 'copy':
        return this.#after_save(
          plan,
          await this.#calls.create({ ...plan, name: `${plan.name} (copy)` }),
        );
      case 'overwrite':
        this.stored = { id: theirs.id, revision: theirs.revision };
        return this.#after_save(plan, await this.#calls.replace(theirs.id, theirs.revision, plan));
      case 'cancel':
        return false;
    }
  }

  /** Takes the stored state as one more step, so that undo brings one's own work back. */
  #adopt(mission: Mission): void {
    const plan = plan_of(mission);
    this.stored = { id: mission.id, revision: mission.revision };
    this.#saved_plan = plan;
    this.do(() => plan);
    this.selected = null;
  }

  async #read(id: string): Promise<Mission | null> {
    const answer = await this.#calls.read(id);
    if (answer.ok) return answer.value;
    this.#notices.show('error', refusal_text(answer.refusal));
    return null;
  }

  /** The stream says that a stored mission changed. */
  async stored_changed(id: string, revision: number | null): Promise<void> {
    if (this.saving || this.stored?.id !== id || this.stored.revision === revision) return;
    if (revision === null) {
      this.stored = null;
      this.#saved_plan = null;
      this.#notices.show('warning', 'The stored mission was deleted; this page still holds it.');
    } else if (this.unsaved) {
      this.#notices.show('warning', `Somebody saved revision ${revision} of this mission.`);
    } else {
      const mission = await this.#read(id);
      if (mission && !this.unsaved) this.#adopt(mission);
    }
  }

  /** What was on this device when the page was last open. */
  restore_draft(): boolean {
    const draft = parse_draft(this.#storage.read());
    if (draft === null || (draft.stored === null && draft.plan.items.length === 0)) return false;
    this.#begin(draft.plan, draft.stored);
    this.adding = draft.plan.items.length === 0;
    if (draft.unsaved) {
      this.#saved_plan = null;
      this.#notices.show('info', `Restored your unsaved draft “${draft.plan.name}”.`);
    }
    return true;
  }

  write_draft(): void {
    clearTimeout(this.#draft_timer);
    this.#storage.write(
      draft_text({ plan: this.plan, stored: this.stored, unsaved: this.unsaved }),
    );
  }

  #begin(plan: Plan, stored: Stored | null): void {
    this.history = begin_history(plan);
    this.#saved_plan = plan;
    this.stored = stored;
    this.selected = null;
    this.refused = new Set();
    this.write_draft();
  }

  #set_history(history: History<Plan>): void {
    if (history === this.history) return;
    this.history = history;
    this.refused = new Set();
    if (this.selected !== null && this.selected >= history.present.items.length) {
      this.selected = null;
    }
    clearTimeout(this.#draft_timer);
    this.#draft_timer = setTimeout(() => this.write_draft(), DRAFT_AFTER_MS);
  }
}
