// The stored missions: list, open, delete, import.

import { refusal_text } from '../model/answer';
import type { MissionCalls, MissionSummary } from '../model/ports';
import type { Dialogs } from './dialogs.svelte';
import type { Editor } from './editor.svelte';
import type { Notices } from './notices.svelte';

export class Library {
  items = $state.raw<readonly MissionSummary[]>([]);
  next_cursor = $state.raw<string | null>(null);
  loading = $state(false);
  failure = $state<string | null>(null);
  search = $state('');
  found = $derived(
    this.items.filter(({ name }) => name.toLowerCase().includes(this.search.trim().toLowerCase())),
  );

  readonly #calls: MissionCalls;
  readonly #editor: Editor;
  readonly #notices: Notices;
  readonly #dialogs: Dialogs;

  constructor(calls: MissionCalls, editor: Editor, notices: Notices, dialogs: Dialogs) {
    this.#calls = calls;
    this.#editor = editor;
    this.#notices = notices;
    this.#dialogs = dialogs;
  }

  export_address(id: string, format: string): string {
    return this.#calls.export_address(id, format);
  }

  async refresh(): Promise<void> {
    await this.#fetch(null);
  }

  async more(): Promise<void> {
    if (this.next_cursor !== null) await this.#fetch(this.next_cursor);
  }

  async #fetch(cursor: string | null): Promise<void> {
    this.loading = true;
    const answer = await this.#calls.list(cursor);
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
    if (!answer.ok) {
      this.#notices.show('error', refusal_text(answer.refusal));
      return false;
    }
    this.#editor.show_mission(answer.value);
    return true;
  }

  async remove(mission: MissionSummary): Promise<void> {
    const sure = await this.#dialogs.ask({
      title: 'Delete mission?',
      text: `“${mission.name}” with ${mission.items} items will be deleted.`,
      yes: 'Delete',
      danger: true,
    });
    if (!sure) return;
    const answer = await this.#calls.remove(mission.id, mission.revision);
    if (answer.ok) this.#notices.show('good', `Deleted “${mission.name}”.`);
    else this.#notices.show('error', `Not deleted: ${refusal_text(answer.refusal)}`);
    await this.refresh();
  }

  /** @return whether the imported mission is now in the editor */
  async import_file(file: File): Promise<boolean> {
    if (!(await this.#editor.may_discard())) return false;
    const answer = await this.#calls.import_file(file.name, await file.text());
    if (!answer.ok) {
      const text = refusal_text(answer.refusal);
      this.#notices.show('error', `“${file.name}” was not imported: ${text}`);
      return false;
    }
    this.#editor.show_mission(answer.value.mission);
    this.#dialogs.show({ kind: 'report', file: file.name, result: answer.value });
    await this.refresh();
    return true;
  }
}
