// What a request to the server ended in. A refusal is a value, not an exception: the page shows the
// robot's own words.

import { robot_says } from './robot_words';
import { row_words } from './import_rows';
import type { Mission } from './ports';
import { say } from './say';

export interface FieldError {
  /** JSON pointer, a line of a file, or the id of a failing check. */
  readonly pointer: string;
  readonly detail: string;
}
export interface Refusal {
  /** HTTP status; 0: no answer came. */
  readonly status: number;
  readonly title: string;
  readonly detail: string;
  readonly errors: readonly FieldError[];
  /** Of a file: what would become of its rows if the wrong ones were left out. */
  readonly rest?: { readonly taken: number; readonly changed: number; readonly left_out: number };
  /** With 412: what is stored now. */
  readonly current?: Mission;
}
export type Answer<T> =
  { readonly ok: true; readonly value: T } | { readonly ok: false; readonly refusal: Refusal };

/** What the sentence before them does not say already. */
const new_causes = ({ detail, errors }: Refusal): readonly FieldError[] =>
  errors.filter((error) => !detail.includes(error.detail));

/** The robot's sentence, with the fields that it names in words: "/areas/0/polygon crosses itself". Paths
 * of its interface stay. */
const sentence_of = ({ detail, errors }: Refusal): string => {
  const said = robot_says(detail);
  if (said !== detail) return said;
  const named = new Set(errors.map(({ pointer }) => pointer));
  return detail.replace(/(?<=^|[\s(])\/[\w/]*\w/g, (path) =>
    named.has(path) || /\/\d/.test(path) ? row_words(path) : path,
  );
};

/** Each place that is wrong, in words: "line 3: latitude must …". */
export const places_wrong = ({ errors }: Refusal): readonly string[] =>
  errors.map(({ pointer, detail }) =>
    pointer === '' ? robot_says(detail) : `${row_words(pointer)}: ${robot_says(detail)}`,
  );

/** One line for a person: the cause, then what is wrong in each place. */
export const refusal_text = (refusal: Refusal): string => {
  const causes = places_wrong({ ...refusal, errors: new_causes(refusal) });
  return [refusal.detail === '' ? refusal.title : sentence_of(refusal), ...causes].join(' · ');
};

/** A change that did not come about; without an answer nobody knows. @param done "saved" */
export const failure_text = (done: string, refusal: Refusal): string =>
  refusal.status === 0
    ? say('it_is_not_known_whether_it_was_done', { done })
    : say('not_done_refusal', { done, refusal: refusal_text(refusal) });

/** Indices of the items that a refusal names ("/items/3/lat" → 3). */
export const refused_items = (refusal: Refusal): ReadonlySet<number> => {
  const found = new Set<number>();
  for (const { pointer } of refusal.errors) {
    const match = /^\/items\/(\d+)(\/|$)/.exec(pointer);
    if (match?.[1] !== undefined) found.add(Number(match[1]));
  }
  return found;
};

/** A table in metres that does not say from where. */
export const wants_origin = (refusal: Refusal): boolean =>
  refusal.errors.some(({ detail }) => detail.includes('needs an origin'));

/** What is wrong with what was typed, field by field. */
export const complaint = (refusal: Refusal): string =>
  [
    sentence_of(refusal),
    ...new_causes(refusal).map((e) => `${row_words(e.pointer)} ${robot_says(e.detail)}`),
  ].join('; ');
