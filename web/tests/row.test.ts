import { describe, expect, it } from 'vitest';
import { row_figures, row_line, type RowDriven } from '../src/model/row';

const seen_now = {
  offset_m: -0.031,
  angle_deg: 1,
  sigma_m: 0.022,
  width_m: 1.93,
  to_end_m: null,
  age_s: 0,
};
const row: RowDriven = {
  item: 3,
  side: 'both',
  seeing: 'line',
  state: 'driving',
  driven_m: 6.24,
  left_m: null,
  seen: seen_now,
};

describe('a row that is driven along', () => {
  it('says what becomes of it', () => {
    expect(row_line(row)).toBe('Item 3 drives along its row, 6.2 m driven.');
    expect(row_line({ ...row, state: 'waiting', left_m: 2 })).toBe(
      'Item 3 waits: its row is not seen surely enough, 6.2 m driven, 2.0 m left.',
    );
  });
  it('says where in it the robot is, and how sure that is', () => {
    expect(row_figures(row)).toBe('3 cm right ± 2 cm · 1.93 m wide');
    const seen = { ...seen_now, offset_m: 0.001, width_m: null, to_end_m: -0.1 };
    expect(row_figures({ ...row, seen })).toBe('in the middle ± 2 cm · end in 0.0 m');
    expect(row_figures({ ...row, side: 'left', seen })).toBe(
      'at its distance ± 2 cm · end in 0.0 m',
    );
  });
  it('has no figures of a row that is not seen', () => {
    expect(row_figures({ ...row, seen: null })).toBe('');
  });
});
