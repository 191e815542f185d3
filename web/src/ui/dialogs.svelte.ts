// The one dialog that is open: a question, a conflict, an import's report, the start of a mission,
// what was found before arming, the menu of modes.

import type { CheckReport, ImportResult, Mission, StartFrom } from '../model/ports';
import type { Preview } from '../model/vehicle';

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
  | { readonly kind: 'report'; readonly file: string; readonly result: ImportResult }
  | { readonly kind: 'start'; readonly preview: Preview; readonly from: StartFrom }
  | { readonly kind: 'check'; readonly name: string; readonly report: CheckReport }
  | { readonly kind: 'arm'; readonly name: string; readonly report: CheckReport }
  | { readonly kind: 'modes' }
  | { readonly kind: 'place' }
  | { readonly kind: 'keys' };

export class Dialogs {
  open = $state.raw<Dialog | null>(null);

  show(dialog: Dialog): void {
    this.close();
    this.open = dialog;
  }

  /** Closing without a choice is the harmless choice. */
  close(): void {
    const dialog = this.open;
    this.open = null;
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
    this.open = null;
    answer(choice);
  }
}
