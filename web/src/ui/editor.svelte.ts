// The mission being edited: its history, what is stored of it, and the draft on the device.

import { failure_text, refusal_text } from '../model/answer';
import { append_waypoint, insert_waypoint, move_waypoint, remove_item } from '../model/actions';
import type { PlanAction } from '../model/actions';
import { cuts_revived } from '../model/cuts';
import { draft_text, parse_draft, type Stored } from '../model/draft';
import { FirstSave } from '../model/first_save';
import { begin_history, perform, redo, undo, type History } from '../model/history';
import { edits_left, edits_resumed, keep_past, parse_past } from '../model/past_edits';
import { EMPTY_PLAN, type LatLon, type Plan } from '../model/plan';
import { say } from '../model/say';
import { followed, joined, NOTHING_PICKED, toggled, type Picked } from '../model/selection';
import { drag_items } from '../model/shapes';
import { revived, steps_of } from '../model/steps';
import { plan_of } from '../model/stored_plan';
import { remove_items } from '../model/stretch';
import type { DraftStorage, MapMode, Mission, MissionCalls } from '../model/ports';
import type { Drawing } from './drawing.svelte';
import type { Dialogs } from './dialogs.svelte';
import type { Kept, Preview } from './edited';
import { fresh_key } from './fresh_key';
import type { Notices } from './notices.svelte';
import { Saving } from './saving.svelte';
import { Splits } from './splits.svelte';

const DRAFT_AFTER_MS = 300;

/** Add with every tap; move and select; choose several. */
export type Tool = 'draw' | 'edit' | 'pick';

export class Editor implements Drawing {
  history = $state.raw<History<Plan>>(begin_history(EMPTY_PLAN));
  /** Which revision the plan is based on; null: never saved. */
  stored = $state.raw<Stored | null>(null);
  selected = $state<number | null>(null);
  /** What a tap on the map does; exactly one. */
  tool = $state<Tool>('draw');
  /** Several items, chosen together; then none is selected alone. */
  picked = $state.raw<Picked>(NOTHING_PICKED);
  /** A dragged point is caught by what lies near. */
  snaps = $state(true);
  /** What somebody else stored meanwhile, while the person chooses. */
  theirs = $state.raw<Plan | null>(null);
  refused = $state.raw<ReadonlySet<number>>(new Set());
  #saved_plan = $state.raw<Plan | null>(EMPTY_PLAN);
  #preview: Preview | null = null;

  plan = $derived(this.history.present);
  unsaved = $derived(this.plan !== this.#saved_plan);
  can_undo = $derived(this.history.past.length > 0);
  can_redo = $derived(this.history.future.length > 0);
  readonly shape = 'line';
  map_mode = $derived<MapMode>(this.tool);

  readonly #calls: MissionCalls;
  readonly #first: FirstSave;
  readonly #saving: Saving;
  readonly #storage: DraftStorage;
  /** Of missions that are not here now. */
  readonly #past: DraftStorage;
  readonly #notices: Notices;
  readonly #dialogs: Dialogs;
  readonly #splits: Splits;
  #draft_timer: ReturnType<typeof setTimeout> | undefined;

  constructor(calls: MissionCalls, kept: Kept, notices: Notices, dialogs: Dialogs) {
    this.#calls = calls;
    this.#first = new FirstSave(calls, fresh_key);
    this.#saving = new Saving(this, calls, this.#first, notices, dialogs);
    this.#storage = kept.draft;
    this.#past = kept.past;
    this.#notices = notices;
    this.#dialogs = dialogs;
    this.#splits = new Splits(calls, notices, () => this.write_draft());
  }

  get saving(): boolean {
    return this.#saving.busy;
  }

  /** Every tap on the map adds a waypoint. */
  get adding(): boolean {
    return this.tool === 'draw';
  }

  set adding(adds: boolean) {
    this.choose_tool(adds ? 'draw' : 'edit');
  }

  /** Whoever stops choosing has nothing chosen any more. */
  choose_tool(tool: Tool): void {
    this.tool = tool;
    if (tool === 'pick') this.selected = null;
    else this.picked = NOTHING_PICKED;
  }

  do(action: PlanAction): void {
    this.#set_history(perform(this.history, action));
  }

  /** @param preview is ended by a step back, and must be before anything is stored */
  previewed_by(preview: Preview): void {
    this.#preview = preview;
  }

  get why_not_save(): string | null {
    return this.#preview?.open ? say('apply_or_cancel_the_change_first') : null;
  }

  undo(): void {
    this.#preview?.cancel();
    this.#splits.back(this.plan);
    this.#set_history(undo(this.history));
  }

  redo(): void {
    this.#preview?.cancel();
    this.#set_history(redo(this.history));
    this.#splits.forward(this.plan);
  }

  add(at: LatLon): void {
    this.do(append_waypoint(at));
    this.selected = null;
  }

  select(index: number | null): void {
    this.selected = index;
    this.picked = NOTHING_PICKED;
  }

  /** One more of several, or one less; what was selected alone is one of them. */
  pick(index: number): void {
    const before = this.selected === null ? this.picked : joined(this.picked, [this.selected]);
    this.pick_only(toggled(before, index));
  }

  pick_more(indices: readonly number[]): void {
    const before = this.selected === null ? [] : [this.selected];
    this.pick_only(joined(joined(this.picked, before), indices));
  }

  pick_only(picked: Picked): void {
    this.picked = picked;
    this.selected = null;
    if (picked.size > 0) this.tool = 'pick';
  }

  insert(index: number, at: LatLon): void {
    this.do(insert_waypoint(index, at));
    this.selected = index;
  }

  move(index: number, to: LatLon): void {
    if (this.picked.has(index)) {
      this.do(drag_items(this.picked, index, to));
      return;
    }
    this.do(move_waypoint(index, to));
    this.selected = index;
  }

  remove_selected(): void {
    if (this.selected !== null) this.remove(this.selected);
    else if (this.picked.size > 0) {
      this.do(remove_items(this.picked));
      this.picked = NOTHING_PICKED;
    }
  }

  remove(index: number): void {
    this.do(remove_item(index));
    this.selected = null;
  }

  /** The first part stays here, to be saved; the second one is stored as a mission of its own. */
  async split(parts: readonly [Plan, Plan]): Promise<void> {
    this.#saving.busy = true;
    const first = await this.#splits.make(parts);
    this.#saving.busy = false;
    if (!first) return;
    this.do(() => first);
    this.choose_tool('edit');
  }

  /** An empty plan; undo brings back what was never saved. Whoever calls has asked. */
  begin_new(): void {
    this.#keep_edits();
    const unkept = this.stored === null ? this.history : begin_history(EMPTY_PLAN);
    const begun = perform(unkept, () => EMPTY_PLAN);
    this.#begin(begun, null);
    this.adding = true;
  }

  /** As it is stored. What was done to it before, on this device, can be undone. */
  show_mission(mission: Mission): void {
    this.#keep_edits();
    const stored = { id: mission.id, revision: mission.revision };
    const past = parse_past(this.#past.read());
    const { history, cuts } = edits_resumed(past, stored, plan_of(mission));
    this.#splits.resume(cuts);
    this.#begin(history, stored);
    this.adding = mission.items.length === 0;
  }

  /** A plan made elsewhere, in place of the one here: whoever calls has asked. @return null: it could not be */
  async keep_as_new(plan: Plan): Promise<Mission | null> {
    const answer = await this.#calls.create(plan);
    if (!answer.ok) {
      this.#notices.show('error', failure_text(say('done_kept'), answer.refusal));
      return null;
    }
    this.show_mission(answer.value);
    return answer.value;
  }

  /** True when it is safe to replace the plan: nothing unsaved, or the person said so. */
  async may_discard(): Promise<boolean> {
    if (!this.unsaved) return true;
    return this.#dialogs.ask({
      title: say('discard_unsaved_changes'),
      text: say(
        this.stored === null
          ? 'name_has_changes_that_are_not_saved'
          : 'name_has_changes_undo_brings_them_back',
        { name: this.plan.name },
      ),
      yes: say('discard'),
      danger: true,
    });
  }

  /** @return it is stored */
  save(): Promise<boolean> {
    return this.#saving.save();
  }

  /** What nobody answered, as soon as the robot answers again. */
  save_again(): Promise<void> {
    return this.#saving.again();
  }

  /** The robot has stored it. */
  stored_as(plan: Plan, stored: Stored): void {
    this.stored = stored;
    this.#saved_plan = plan;
    this.refused = new Set();
    this.write_draft();
  }

  /** Takes the stored state as one more step, so that undo brings one's own work back. */
  adopt(mission: Mission): void {
    // The stream may have told of it already: one change is one step.
    const known = this.stored?.id === mission.id && this.stored.revision === mission.revision;
    if (known && !this.unsaved) return;
    const plan = plan_of(mission);
    this.stored = { id: mission.id, revision: mission.revision };
    this.#saved_plan = plan;
    this.do(() => plan);
    this.selected = null;
  }

  async read(id: string): Promise<Mission | null> {
    const answer = await this.#calls.read(id);
    if (answer.ok) return answer.value;
    this.#notices.show('error', refusal_text(answer.refusal));
    return null;
  }

  /** The stream says that a stored mission changed. */
  async stored_changed(id: string, revision: number | null): Promise<void> {
    if (
      this.saving ||
      this.#saving.owed ||
      this.stored?.id !== id ||
      this.stored.revision === revision
    )
      return;
    if (revision === null) {
      this.stored = null;
      this.#saved_plan = null;
      this.#notices.show('warning', say('the_stored_mission_was_deleted_this'));
    } else if (this.unsaved) {
      this.#notices.show('warning', say('somebody_saved_revision_revision_of', { revision }));
    } else {
      const mission = await this.read(id);
      if (mission && !this.unsaved) this.adopt(mission);
    }
  }

  /** What was on this device when the page was last open. */
  restore_draft(): boolean {
    const draft = parse_draft(this.#storage.read());
    if (draft === null || (draft.stored === null && draft.plan.items.length === 0)) return false;
    const { history, saved } = draft.steps
      ? revived(draft.plan, draft.steps)
      : { history: begin_history(draft.plan), saved: null };
    this.history = history;
    this.#splits.resume(cuts_revived(history, draft.cuts));
    this.#saved_plan = draft.unsaved ? saved : draft.plan;
    this.stored = draft.stored;
    this.#first.tried = draft.tried ?? null;
    this.#saving.owe(draft.owed === true);
    this.adding = draft.plan.items.length === 0;
    if (draft.unsaved) {
      this.#notices.show(
        'info',
        say('restored_your_unsaved_draft_name', { name: draft.plan.name }),
      );
    }
    return true;
  }

  write_draft(): void {
    clearTimeout(this.#draft_timer);
    const { history, plan, stored, unsaved } = this;
    const draft = { plan, stored, unsaved, ...(this.#saving.owed ? { owed: true } : {}) };
    const { tried } = this.#first;
    const steps = { steps: steps_of(history, this.#saved_plan), cuts: this.#splits.kept(history) };
    // Where there is no room for what can be undone, the plan itself goes before.
    if (!this.#storage.write(draft_text({ ...draft, ...(tried ? { tried } : {}), ...steps }))) {
      this.#storage.write(draft_text(draft));
    }
  }

  /** Before another mission comes. */
  #keep_edits(): void {
    if (this.stored === null) return;
    const left = edits_left(this.history, this.#saved_plan, this.stored, this.#splits.all);
    if (left !== null) keep_past(this.#past, left);
  }

  #begin(history: History<Plan>, stored: Stored | null): void {
    this.history = history;
    this.#saved_plan = history.present;
    this.stored = stored;
    this.#first.tried = null;
    this.#saving.begin_anew();
    this.selected = null;
    this.picked = NOTHING_PICKED;
    this.refused = new Set();
    this.write_draft();
  }

  #set_history(history: History<Plan>): void {
    if (history === this.history) return;
    const { plan } = this;
    this.history = history;
    this.refused = new Set();
    if (this.selected !== null) {
      const [selected = null] = followed(new Set([this.selected]), plan, history.present);
      this.selected = selected;
    }
    this.picked = followed(this.picked, plan, history.present);
    clearTimeout(this.#draft_timer);
    this.#draft_timer = setTimeout(() => this.write_draft(), DRAFT_AFTER_MS);
  }
}
