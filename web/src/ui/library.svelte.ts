// The stored missions: list, search, open, tag, archive, delete, check, import.

import { type Answer, failure_text, refusal_text, wants_origin } from '../model/answer';
import type { LatLon } from '../model/plan';
import { rest_question } from '../model/import_rest';
import type {
  CheckReport,
  ImportHints,
  ImportResult,
  Mission,
  MissionCalls,
  MissionSummary,
  Place,
} from '../model/ports';
import { say } from '../model/say';
import type { Dialogs } from './dialogs.svelte';
import type { Editor } from './editor.svelte';
import { ImportReport } from './import_report.svelte';
import type { Notices } from './notices.svelte';

const SEARCH_AFTER_MS = 250;
/** Of a file, to see where that lies which was left out. */
const READ_AGAIN_BYTES = 8_000_000;
/** Of a file's missions, on the map beside its report. */
const MISSIONS_SHOWN = 30;

export class Library {
  items = $state.raw<readonly MissionSummary[]>([]);
  next_cursor = $state.raw<string | null>(null);
  loading = $state(false);
  failure = $state<string | null>(null);
  name = $state('');
  tag = $state('');
  place = $state<Place>('present');
  /** Of what has been listed, to choose from. */
  tags = $derived([...new Set(this.items.flatMap(({ tags }) => tags ?? []))].sort());
  readonly #calls: MissionCalls;
  readonly #editor: Editor;
  readonly #notices: Notices;
  readonly #dialogs: Dialogs;
  readonly #origin: () => LatLon | null;
  #typing: ReturnType<typeof setTimeout> | undefined;
  /** Of two answers the later question's counts. */
  #question = 0;

  /** @param origin for a file in metres that does not tell its own: home, else the robot */
  constructor(
    calls: MissionCalls,
    editor: Editor,
    notices: Notices,
    dialogs: Dialogs,
    origin: () => LatLon | null,
  ) {
    this.#calls = calls;
    this.#editor = editor;
    this.#notices = notices;
    this.#dialogs = dialogs;
    this.#origin = origin;
  }

  export_address(id: string, format: string): string {
    return this.#calls.export_address(id, format);
  }

  /** Of a file that is refused a browser says only that it failed. */
  async tell_export(id: string, format: string): Promise<void> {
    const refusal = await this.#calls.export_refusal(id, format);
    const lies_nowhere = refusal?.status === 409;
    // Asked for once more, it may be refused for other reasons than the file was.
    const why = lies_nowhere ? say('it_counts_from_a_map_that_lies_nowhere') : null;
    this.#notices.outcome('export', why);
  }

  async refresh(): Promise<void> {
    await this.#fetch(null);
  }

  /** With every letter; asks when the person pauses. */
  search(name: string): void {
    this.name = name;
    clearTimeout(this.#typing);
    this.#typing = setTimeout(() => void this.refresh(), SEARCH_AFTER_MS);
  }

  filter(change: { readonly place?: Place; readonly tag?: string }): void {
    if (change.place !== undefined && change.place !== this.place) this.#look_in(change.place);
    this.tag = change.tag ?? this.tag;
    void this.refresh();
  }

  /** What can be done with a row depends on where it lies: those of the place before must not
   * stand under this one's buttons while the answer is on its way. */
  #look_in(place: Place): void {
    this.place = place;
    this.items = [];
    this.next_cursor = null;
  }

  async more(): Promise<void> {
    if (this.next_cursor !== null) await this.#fetch(this.next_cursor);
  }

  async #fetch(cursor: string | null): Promise<void> {
    this.loading = true;
    const question = (this.#question += 1);
    const filter = { place: this.place, name: this.name.trim(), tag: this.tag };
    const answer = await this.#calls.list(filter, cursor);
    if (question !== this.#question) return;
    this.loading = false;
    if (!answer.ok) {
      this.failure = refusal_text(answer.refusal);
      return;
    }
    this.failure = null;
    const fresh = answer.value.items;
    const ids = new Set(fresh.map(({ id }) => id));
    const before = cursor === null ? [] : this.items.filter(({ id }) => !ids.has(id));
    this.items = [...before, ...fresh];
    this.next_cursor = answer.value.next_cursor;
  }

  /** @return whether it is now in the editor */
  async open(id: string): Promise<boolean> {
    if (!(await this.#editor.may_discard())) return false;
    const answer = await this.#calls.read(id);
    this.#notices.tried(`open ${id}`, answer.ok ? null : refusal_text(answer.refusal));
    if (!answer.ok) return false;
    this.#editor.show_mission(answer.value);
    return true;
  }

  async remove(mission: MissionSummary): Promise<void> {
    const sure = await this.#dialogs.ask({
      title: say('delete_mission'),
      text: say('name_with_items_items_will_be_deleted', {
        name: mission.name,
        items: mission.items,
      }),
      yes: say('delete_it'),
      danger: true,
    });
    if (!sure) return;
    const answer = await this.#calls.remove(mission.id, mission.revision);
    this.#notices.tried(
      `delete ${mission.id}`,
      answer.ok ? null : failure_text(say('done_deleted'), answer.refusal),
    );
    if (answer.ok) this.#notices.show('good', say('deleted_name', { name: mission.name }));
    await this.refresh();
  }

  set_tags = (mission: MissionSummary, tags: readonly string[]): Promise<void> =>
    this.#change(say('tags_not_changed'), mission.id, () =>
      this.#calls.describe(mission.id, mission.revision, { tags }),
    );

  set_archived = (mission: MissionSummary, archived: boolean): Promise<void> =>
    this.#change(archived ? say('not_archived') : say('not_brought_back'), mission.id, () =>
      this.#calls.describe(mission.id, mission.revision, { archived }),
    );

  restore = (mission: MissionSummary): Promise<void> =>
    this.#change(say('not_brought_back'), mission.id, () =>
      this.#calls.restore(mission.id, mission.revision),
    );

  copy = (mission: MissionSummary): Promise<void> =>
    this.#change(say('not_copied'), mission.id, () => this.#calls.copy(mission.id));

  async #change(failed: string, id: string, call: () => Promise<Answer<Mission>>): Promise<void> {
    const answer = await call();
    this.#notices.tried(
      `${failed} ${id}`,
      answer.ok ? null : `${failed}: ${refusal_text(answer.refusal)}`,
    );
    await this.refresh();
  }

  /** What speaks against driving the stored mission, in a dialog. */
  async check(id: string, revision: number, name: string): Promise<void> {
    const answer = await this.#calls.check(id, revision);
    this.#notices.tried(
      `check ${id}`,
      answer.ok ? null : say('not_checked_refusal', { refusal: refusal_text(answer.refusal) }),
    );
    if (answer.ok) this.#dialogs.show({ kind: 'check', name, report: answer.value });
  }

  /** The same, for whoever shows it himself. */
  check_report(id: string, revision: number): Promise<Answer<CheckReport>> {
    return this.#calls.check(id, revision);
  }

  /** One after the other: each report is read before the next file comes.
   * @param shown hears that one of them is in the editor */
  async import_files(files: readonly File[], shown: () => void): Promise<void> {
    const refused: (readonly [about: string, failure: string])[] = [];
    for (const file of files) {
      const failure = await this.#import(file, shown);
      if (failure !== null) refused.push([`file ${file.name}`, failure]);
      await this.#dialogs.gone();
    }
    // The next file was no doing of the person's: what became of this one is still to be read.
    if (files.length > 1) for (const each of refused) this.#notices.tried(...each);
  }

  /** @param shown hears that it is now in the editor. @return why it was not imported; null: it was, or
   * the person does not want it */
  async #import(file: File, shown: () => void): Promise<string | null> {
    if (!(await this.#editor.may_discard())) return null;
    const answer = await this.#ask_import(file);
    const refusal = answer === null || answer.ok ? null : answer.refusal;
    const failure =
      refusal &&
      say('name_was_not_imported_text', { name: file.name, text: refusal_text(refusal) });
    this.#notices.tried(`file ${file.name}`, failure);
    if (!answer?.ok) return failure;
    const { mission } = answer.value;
    if (mission) this.#editor.show_mission(mission);
    const text = file.size <= READ_AGAIN_BYTES ? await file.text() : null;
    const report = new ImportReport(file.name, answer.value, text);
    this.#dialogs.show({ kind: 'report', report });
    void this.#fetch_others(report);
    await this.refresh();
    if (mission) shown();
    return null;
  }

  /** Asks what a refusal leaves open. @return null: the person does not want it so */
  async #ask_import(file: File): Promise<Answer<ImportResult> | null> {
    let hints: ImportHints = { origin: null, rest: false };
    const origin = this.#origin();
    let answer = await this.#calls.import_file(file, hints);
    if (!answer.ok && origin && wants_origin(answer.refusal)) {
      const here = await this.#dialogs.ask({
        title: say('where_does_it_begin'),
        text: say('name_counts_metres_from_an_origin', { name: file.name }),
        yes: say('take_home'),
        danger: false,
      });
      if (!here) return null;
      hints = { ...hints, origin };
      answer = await this.#calls.import_file(file, hints);
    }
    if (answer.ok || !answer.refusal.rest) return answer;
    const so = await this.#dialogs.ask(rest_question(file.name, answer.refusal));
    return so ? this.#calls.import_file(file, { ...hints, rest: true }) : null;
  }

  /** The first mission of the file came with the report. */
  async #fetch_others(report: ImportReport): Promise<void> {
    for (const [k, { id }] of report.result.missions.slice(0, MISSIONS_SHOWN).entries()) {
      if (k === 0) continue;
      const answer = await this.#calls.read(id);
      if (answer.ok) report.take_plan(k + 1, answer.value);
    }
  }
}
