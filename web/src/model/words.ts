// Whether two states differ by more than figures. Numbers change with every message, and may be shown a
// moment later; a word, a yes or no, or that something is there at all, at once.

type Fields = Readonly<Record<string, unknown>>;

const is_object = (value: unknown): value is Fields => typeof value === 'object' && value !== null;

/** @param but names of fields that do not count, at the top only */
export const same_words = (a: unknown, b: unknown, but: readonly string[] = []): boolean => {
  if (a === b) return true;
  if (typeof a === 'number' && typeof b === 'number') return true;
  if (!is_object(a) || !is_object(b)) return false;
  const names = Object.keys(a);
  if (names.length !== Object.keys(b).length) return false;
  return names.every((name) => but.includes(name) || (name in b && same_words(a[name], b[name])));
};
