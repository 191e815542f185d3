// Which rows of a long list are worth making: those in sight, and a few beyond.

export interface RowWindow {
  readonly first: number;
  /** One after the last. */
  readonly end: number;
}

const BEYOND = 6;

/** @param height_px of the part in sight */
export const row_window = (
  count: number,
  row_px: number,
  scrolled_px: number,
  height_px: number,
): RowWindow => {
  const first = Math.max(0, Math.floor(scrolled_px / row_px) - BEYOND);
  const end = Math.min(count, Math.ceil((scrolled_px + height_px) / row_px) + BEYOND);
  return { first: Math.min(first, end), end };
};

/** Where to scroll so that a row is wholly in sight; as little as possible. */
export const scroll_to_row = (
  row: number,
  row_px: number,
  scrolled_px: number,
  height_px: number,
): number => {
  const top = row * row_px;
  if (top < scrolled_px) return top;
  return Math.max(scrolled_px, top + row_px - height_px);
};
