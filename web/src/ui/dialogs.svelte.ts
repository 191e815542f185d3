// The one dialog that is open: a question, a conflict, an import's report, the start of a mission,
// what was found before arming, the menu of modes.

import type { CheckReport, Mission, StartFrom } from '../model/ports';
import type { Preview } from '../model/vehicle';
import type { ImportReport } from './import_report.svelte';

export interface Question {
  readonly title: string;
  readonly text: string;
  readonly yes: string;
  readonly danger: boolean;
}
export type ConflictChoice = 'theirs' | 'copy' | 'overwrite' | 'cancel';

export type Dialog =
  | { readonly kind: 'question'; readonly question: Question; answer(yes: boolean): void }
  | {
      readonly kind: 'conflict';
      readonly mine: number;
      readonly theirs: Mission;
      answer(choice: ConflictChoice): void;
    }
  | { readonly kind: 'report'; readonly report: ImportReport }
  | { readonly kind: 'start'; readonly preview: Preview; readonly from: StartFrom }
  | { readonly kind: 'check'; readonly name: string; readonly report: CheckReport }
  | { readonly kind: 'arm'; readonly name: string; readonly report: CheckReport }
  | { readonly kind: 'modes' }
  | { readonly kind: 'place' }
  | { readonly kind: 'keys' };

export class Dialogs {
  open = $state.raw<Dialog | null>(null);
  #waiting: readonly (() => void)[] = [];

  show(dialog: Dialog): void {
    this.close();
    this.open = dialog;
  }

  /** When nothing is open any more. */
  async gone(): Promise<void> {
    while (this.open !== null) {
      await new Promise<void>((resolve) => {
        this.#waiting = [...this.#waiting, resolve];
      });
    }
  }

  /** Closing without a choice is the harmless choice. */
  close(): void {
    const dialog = this.open;
    this.#end();
    if (dialog?.kind === 'question') dialog.answer(false);
    if (dialog?.kind === 'conflict') dialog.answer('cancel');
  }

  ask(question: Question): Promise<boolean> {
    return new Promise((resolve) => {
      this.show({ kind: 'question', question, answer: resolve });
    });
  }

  conflict(mine: number, theirs: Mission): Promise<ConflictChoice> {
    return new Promise((resolve) => {
      this.show({ kind: 'conflict', mine, theirs, answer: resolve });
    });
  }

  /** Ends a question or conflict with a choice. */
  choose<T>(answer: (choice: T) => void, choice: T): void {
    this.#end();
    answer(choice);
  }

  #end(): void {
    this.open = null;
    const waiting = this.#waiting;
    this.#waiting = [];
    for (const each of waiting) each();
  }
}
