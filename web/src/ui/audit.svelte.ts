// Who did what: a page of rows at a time, and whether they are as they were written.

import { refusal_text } from '../model/answer';
import {
  ANY_DEED,
  type AuditCalls,
  type Deed,
  type DeedCheck,
  type DeedFilter,
} from '../model/audit';

export class Audit {
  /** More are not held on a page: who wants them narrows the search, or exports. */
  static readonly MOST = 500;

  filter = $state<DeedFilter>({ ...ANY_DEED });
  items = $state.raw<readonly Deed[]>([]);
  next_cursor = $state.raw<string | null>(null);
  loading = $state(false);
  failure = $state<string | null>(null);
  checking = $state(false);
  check = $state.raw<DeedCheck | null>(null);
  check_failure = $state<string | null>(null);

  readonly full = $derived(this.items.length >= Audit.MOST);
  readonly #calls: AuditCalls;
  #asked = 0;

  constructor(calls: AuditCalls) {
    this.#calls = calls;
  }

  refresh = (): Promise<void> => this.#fetch(null);

  async more(): Promise<void> {
    if (this.next_cursor !== null && !this.full) await this.#fetch(this.next_cursor);
  }

  look_through = async (): Promise<void> => {
    if (this.checking) return;
    this.checking = true;
    const answer = await this.#calls.check();
    this.checking = false;
    if (answer.ok) this.check = answer.value;
    this.check_failure = answer.ok ? null : refusal_text(answer.refusal);
  };

  export_address(after: number): string {
    return this.#calls.export_address(after);
  }

  /** What is shown stays where no answer comes. */
  async #fetch(cursor: string | null): Promise<void> {
    const call = (this.#asked += 1);
    this.loading = true;
    const answer = await this.#calls.list(this.filter, cursor);
    if (call !== this.#asked) return; // something else is searched for by now
    this.loading = false;
    this.failure = answer.ok ? null : refusal_text(answer.refusal);
    if (!answer.ok) return;
    this.items = cursor === null ? answer.value.items : [...this.items, ...answer.value.items];
    this.next_cursor = answer.value.next_cursor;
  }
}
