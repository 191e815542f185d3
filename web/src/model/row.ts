// The row that a mission drives along by sight, in words.

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

const state_words: Readonly<Record<RowDriven['state'], string>> = {
  seeking: 'looks for its row',
  driving: 'drives along its row',
  waiting: 'waits: its row is not seen surely enough',
};

/** "3 cm right", "in the middle" */
const beside = (offset_m: number, side: RowDriven['side']): string => {
  const cm = Math.round(100 * Math.abs(offset_m));
  if (cm === 0) return side === 'both' ? 'in the middle' : 'at its distance';
  return `${cm} cm ${offset_m > 0 ? 'left' : 'right'}`;
};

/** "Item 3 drives along its row, 6.2 m driven." */
export const row_line = (row: RowDriven): string =>
  `Item ${row.item} ${state_words[row.state]}, ${row.driven_m.toFixed(1)} m driven` +
  (row.left_m === null ? '.' : `, ${row.left_m.toFixed(1)} m left.`);

/** "3 cm right ± 2 cm · 1.93 m wide · end in 2.1 m"; empty: none is seen. */
export const row_figures = ({ seen, side }: RowDriven): string => {
  if (seen === null) return '';
  const parts = [`${beside(seen.offset_m, side)} ± ${Math.round(100 * seen.sigma_m)} cm`];
  if (seen.width_m !== null) parts.push(`${seen.width_m.toFixed(2)} m wide`);
  if (seen.to_end_m !== null) parts.push(`end in ${Math.max(0, seen.to_end_m).toFixed(1)} m`);
  return parts.join(' · ');
};
