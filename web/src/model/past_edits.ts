// What can be undone in missions that are not in the editor now, kept on the device: whoever comes back
// to one finds his steps again, also after a reload.

import { is_record, json_of } from './checked';
import { cuts_kept, cuts_revived, type Cut } from './cuts';
import { draft_text, parse_draft, type Draft, type Stored } from './draft';
import { begin_history, perform, type History } from './history';
import type { Plan } from './plan';
import type { DraftStorage } from './ports';
import { revived, steps_of } from './steps';

export interface KeptEdits {
  /** Of the mission. */
  readonly id: string;
  /** A draft (draft.ts). */
  readonly draft: string;
}

/** Missions, and letters of all their drafts together; the oldest go first. */
const MISSIONS_MOST = 20;
const LETTERS_MOST = 2_000_000;

const is_kept = (value: unknown): value is KeptEdits =>
  is_record(value) && typeof value['id'] === 'string' && typeof value['draft'] === 'string';

/** Newest first. What is damaged is as if it had never been. */
export const parse_past = (text: string | null): readonly KeptEdits[] => {
  const value = json_of(text);
  return Array.isArray(value) ? value.filter(is_kept) : [];
};

/** A mission's place in front of the others, as far as there is room. */
export const with_past = (
  past: readonly KeptEdits[],
  kept: KeptEdits,
  letters_most = LETTERS_MOST,
): readonly KeptEdits[] => {
  let letters = 0;
  return [kept, ...past.filter(({ id }) => id !== kept.id)]
    .slice(0, MISSIONS_MOST)
    .filter(({ draft }) => {
      letters += draft.length;
      return letters <= letters_most;
    });
};

/** Where there is no room for all of them, the newest go before. */
export const keep_past = (shelf: DraftStorage, kept: KeptEdits): void => {
  let past = with_past(parse_past(shelf.read()), kept);
  while (!shelf.write(JSON.stringify(past)) && past.length > 0) {
    past = past.slice(0, Math.floor(past.length / 2));
  }
};

/** How a mission is left: as it is stored. What was not saved lies one step back.
 * @param saved the plan as it is stored; null: not known */
export const left_history = (history: History<Plan>, saved: Plan | null): History<Plan> =>
  saved === null ? history : perform(history, () => saved);

/** @return null: nothing can be undone */
export const edits_left = (
  history: History<Plan>,
  saved: Plan | null,
  stored: Stored,
  cuts: readonly Cut[] = [],
): KeptEdits | null => {
  const left = left_history(history, saved);
  const { past, present, future } = left;
  if (past.length === 0 && future.length === 0) return null;
  const draft: Draft = {
    plan: present,
    stored,
    unsaved: saved === null,
    steps: steps_of(left, saved),
    cuts: cuts_kept(left, cuts),
  };
  return { id: stored.id, draft: draft_text(draft) };
};

export interface Resumed {
  readonly history: History<Plan>;
  /** Those among its steps. */
  readonly cuts: readonly Cut[];
}

/**
 * The history of a mission that comes into the editor.
 * @param plan as it is stored now
 */
export const edits_resumed = (
  past: readonly KeptEdits[],
  { id, revision }: Stored,
  plan: Plan,
): Resumed => {
  const draft = parse_draft(past.find((kept) => kept.id === id)?.draft ?? null);
  if (!draft?.steps) return { history: begin_history(plan), cuts: [] };
  const { history } = revived(draft.plan, draft.steps);
  const as_left = draft.stored?.revision === revision && !draft.unsaved;
  // Somebody else saved it meanwhile: one more step.
  if (!as_left) {
    return { history: perform(history, () => plan), cuts: cuts_revived(history, draft.cuts) };
  }
  const as_stored = { ...history, present: plan };
  return { history: as_stored, cuts: cuts_revived(as_stored, draft.cuts) };
};
