// Figures as a person reads them. What is typed, compared or kept in a file is none of it.

import { decimal_sign } from './say';

/** A minus of typographic width, no "-0.0", and the language's decimal sign. */
export const fixed = (value: number, digits: number): string => {
  const text = value.toFixed(digits);
  const signed = Number(text) === 0 ? text.replace('-', '') : text.replace('-', '−');
  return signed.replace('.', decimal_sign());
};

/** The same without noughts at its end: "0.5". */
export const shortest = (value: number, digits: number): string =>
  String(Number(value.toFixed(digits))).replace('.', decimal_sign());

/** Beside an axis; null: there is none. */
export const tick_text = (value: number | null): string =>
  value === null ? '' : shortest(value, 6).replace('-', '−');
