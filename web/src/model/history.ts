// Undo as a stack of documents. Immutable: every step gives a new history.

export interface History<T> {
  readonly past: readonly T[];
  readonly present: T;
  readonly future: readonly T[];
}

/** Steps kept; the oldest is forgotten first. */
export const HISTORY_LIMIT = 500;

export const begin_history = <T>(present: T): History<T> => ({ past: [], present, future: [] });

/** Does an action. One that changes nothing leaves no step behind. */
export const perform = <T>(history: History<T>, action: (document: T) => T): History<T> => {
  const next = action(history.present);
  if (next === history.present) return history;
  return {
    past: [...history.past, history.present].slice(-HISTORY_LIMIT),
    present: next,
    future: [],
  };
};

export const undo = <T>(history: History<T>): History<T> => {
  const before = history.past.at(-1);
  if (before === undefined) return history;
  return {
    past: history.past.slice(0, -1),
    present: before,
    future: [history.present, ...history.future],
  };
};

export const redo = <T>(history: History<T>): History<T> => {
  const [next, ...later] = history.future;
  if (next === undefined) return history;
  return { past: [...history.past, history.present], present: next, future: later };
};
