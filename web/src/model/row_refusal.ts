// Why a block of rows cannot be driven so, in the page's words: the robot names the member that asks for
// it, and says the rest in its interface's.

import { refusal_text, type FieldError, type Refusal } from './answer';
import { number_text } from './format';
import { say, type PlainKey } from './say';

/** What the form calls a member. */
const LABELS: Readonly<Record<string, PlainKey>> = {
  '/rows': 'rows_to_drive',
  '/spacing_m': 'from_row_to_row_m',
  '/skip': 'rows_left_out_each_time',
  '/out_m': 'out_of_a_row_m',
  '/radius_m': 'radius_m_empty_as_suits_the_vehicle',
  '/heading_deg': 'direction_of_row_1_deg',
  '/gap_m': 'from_the_plants_m',
  '/distance_m': 'only_so_far_m_empty_to_its_end',
};

interface Cause {
  readonly pointer: string;
  /** In the robot's sentence. */
  readonly said: RegExp;
  /** @param figures of the sentence, in its order */
  readonly words: (figures: readonly string[]) => string;
}
const cause = (pointer: string, said: RegExp, key: PlainKey): Cause => ({
  pointer,
  said,
  words: () => say(key),
});
const shown_m = (figure: string | undefined): string => number_text(Number(figure), 1, 'm');

/** By what the server says: the test looks them up in its sources. */
export const CAUSES: readonly Cause[] = [
  cause('/rows', /with a trailer/, 'rows_not_with_a_trailer'),
  cause('/turn_kind', /cannot turn on the spot/, 'row_turns_need_arcs'),
  cause('/turn_kind', /back into the same row/, 'no_arc_into_the_same_row'),
  {
    pointer: '/turn_kind',
    said: /radius of ([\d.]+) m need lanes ([\d.]+) m apart/,
    words: ([radius, apart]) =>
      say('arcs_need_rows_farther_apart', {
        radius: shown_m(radius),
        apart: shown_m(apart),
        omega: say('row_turn_omega'),
        shunt: say('row_turn_shunt'),
      }),
  },
  {
    pointer: '/radius_m',
    said: /at least ([\d.]+): this vehicle turns no narrower/,
    words: ([least]) => say('arcs_are_no_narrower_than', { least: shown_m(least) }),
  },
  cause('/radius_m', /acts with arcs alone/, 'a_radius_is_of_arcs'),
  cause('/radius_m', /is required: this vehicle turns on the spot/, 'arcs_need_a_radius'),
  cause('/block/1', /less than 1 m/, 'row_1_is_too_short'),
  cause('/block/1', /more than 5 km/, 'row_1_is_too_long'),
];

const of_range = ({ pointer, detail }: FieldError): string | null => {
  const label = LABELS[pointer];
  const range = /^must be from ([\d.]+) to ([\d.]+)/.exec(detail);
  if (!label || !range) return null;
  const [, least = '', most = ''] = range;
  return say('field_from_to', { field: say(label), least, most });
};

const words_of = (error: FieldError): string | null => {
  for (const { pointer, said, words } of CAUSES) {
    const found = pointer === error.pointer ? said.exec(error.detail) : null;
    if (found) return words(found.slice(1));
  }
  return of_range(error);
};

/** What the page has no words for is said as the robot says it. */
export const row_refusal = (refusal: Refusal): string => {
  const words = refusal.errors.map(words_of);
  const known = words.filter((text) => text !== null);
  return words.length > 0 && known.length === words.length
    ? known.join(' ')
    : refusal_text(refusal);
};
