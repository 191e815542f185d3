// A file with wrong places is refused; what is right of it can be taken all the same, if the person says so.

import { places_wrong, type Refusal } from './answer';
import { say } from './say';

/** Named in the question; the report names them all. */
const NAMED = 3;

/** What is asked before the rest of a file is taken. */
export const rest_question = (
  name: string,
  refusal: Refusal,
): { title: string; text: string; yes: string; danger: boolean } => {
  const { taken = 0, changed = 0, left_out = 0 } = refusal.rest ?? {};
  const named = places_wrong(refusal);
  const more =
    named.length > NAMED ? [say('and_notable_more', { notable: named.length - NAMED })] : [];
  return {
    title: say('take_the_rest'),
    text: say('file_rest_text', {
      name,
      wrong: [...named.slice(0, NAMED), ...more].join('; '),
      taken: taken + changed,
      left_out,
    }),
    yes: say('take_the_rest_yes'),
    danger: false,
  };
};
