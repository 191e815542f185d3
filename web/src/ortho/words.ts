// What is said of a GeoTIFF.

import { say } from '../model/say';
import type { OfDatum, OrthoTrouble } from './messages';

/** Why it is not taken. */
export const ortho_words = (why: OrthoTrouble, detail: string): string => {
  if (why === 'no_datum') return say('ortho_no_datum', { datum: detail === '' ? '?' : detail });
  return `${say(`ortho_${why}`)}${detail === '' ? '' : ` (${detail})`}`;
};

/** It was taken, but lies less exactly than it looks. */
export const inexact_words = (name: string, { name: datum, good_to_m }: OfDatum): string =>
  good_to_m === null
    ? say('ground_is_there_by_its_own', { name })
    : say('ground_is_there_about', { name, datum, about_m: good_to_m });

/** The same for good, beside the map, in any language. */
export const accuracy_mark = ({ name, good_to_m }: OfDatum): string =>
  `± ${good_to_m ?? '?'} m (${name})`;
