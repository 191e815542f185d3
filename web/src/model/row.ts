// The row that a mission drives along by sight, in words.

import { fixed } from './figures';
import { side_word } from './format';
import { say, told } from './say';

export interface RowDriven {
  readonly item: number;
  readonly side: 'both' | 'left' | 'right';
  readonly seeing: 'line' | 'rays';
  readonly state: 'seeking' | 'driving' | 'waiting';
  readonly driven_m: number;
  /** To where the item ends; null: that is not seen yet. */
  readonly left_m: number | null;
  /** Null: no row is seen. */
  readonly seen: {
    /** Of the vehicle from the line, left positive. */
    readonly offset_m: number;
    readonly angle_deg: number;
    /** 1 sigma of the line 1.5 m ahead. */
    readonly sigma_m: number;
    readonly width_m: number | null;
    readonly to_end_m: number | null;
    readonly age_s: number;
  } | null;
}

const state_words: Readonly<Record<RowDriven['state'], string>> = told({
  seeking: 'looks_for_its_row',
  driving: 'drives_along_its_row',
  waiting: 'waits_its_row_is_not_seen_surely',
});

/** "3 cm right", "in the middle" */
const beside = (offset_m: number, side: RowDriven['side']): string => {
  const cm = Math.round(100 * Math.abs(offset_m));
  if (cm === 0) return side === 'both' ? say('in_the_middle') : say('at_its_distance');
  return `${cm} cm ${side_word(offset_m)}`;
};

/** "Item 3 drives along its row, 6.2 m driven." */
export const row_line = (row: RowDriven): string =>
  say('item_item_state_words_driven_m_driven', {
    item: row.item,
    state_words: state_words[row.state],
    driven: fixed(row.driven_m, 1),
  }) + (row.left_m === null ? '.' : say('left_m_left', { left: fixed(row.left_m, 1) }));

/** "3 cm right ± 2 cm · 1.93 m wide · end in 2.1 m"; empty: none is seen. */
export const row_figures = ({ seen, side }: RowDriven): string => {
  if (seen === null) return '';
  const parts = [`${beside(seen.offset_m, side)} ± ${Math.round(100 * seen.sigma_m)} cm`];
  if (seen.width_m !== null) parts.push(say('width_m_wide', { width: fixed(seen.width_m, 2) }));
  if (seen.to_end_m !== null)
    parts.push(say('end_in_to_end_m', { to_end: fixed(Math.max(0, seen.to_end_m), 1) }));
  return parts.join(' · ');
};
