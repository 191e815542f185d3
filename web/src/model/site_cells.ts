// The cells of a site's map, out of the picture in which the robot sends them.

/** The cells of a map, thinned where there are too many to draw. */
export interface SiteCells {
  readonly columns: number;
  readonly rows: number;
  /** So many of the map's cells are one of these, each way; counted from the lower left. */
  readonly thinned: number;
  /** From the upper left, row by row, as UNKNOWN_CELL and the others. */
  readonly cells: Uint8Array;
}

export const UNKNOWN_CELL = 0;
export const FREE_CELL = 1;
export const OCCUPIED_CELL = 2;
export const FORBIDDEN_CELL = 3;
/** What a page asks for at most. */
export const MOST_CELLS = 1_000_000;

/** As map servers keep them: black is a wall, almost white is free, the grey between is not known;
 * but for one grey of the robot's own. */
const OCCUPIED_TO = 89;
const FORBIDDEN = 100;
const FREE_FROM = 206;

const kind_of = (byte: number): number =>
  byte <= OCCUPIED_TO
    ? OCCUPIED_CELL
    : byte >= FREE_FROM
      ? FREE_CELL
      : byte === FORBIDDEN
        ? FORBIDDEN_CELL
        : UNKNOWN_CELL;

/** The numbers of a picture's head, after "P5": three of them, between blanks and comments. */
const head_of = (bytes: Uint8Array): readonly [figures: number[], end: number] | null => {
  const figures: number[] = [];
  let at = 2;
  while (figures.length < 3) {
    const from = at;
    while (at < bytes.length && /\s/.test(String.fromCharCode(bytes[at] ?? 0))) at += 1;
    if (bytes[at] === 0x23) {
      while (at < bytes.length && bytes[at] !== 0x0a) at += 1;
      continue;
    }
    let value = 0;
    const first = at;
    for (; at - first < 6; at += 1) {
      const digit = (bytes[at] ?? 0) - 0x30;
      if (digit < 0 || digit > 9) break;
      value = 10 * value + digit;
    }
    if (at === first || first === from) return null;
    figures.push(value);
  }
  return [figures, at + 1];
};

/** A grey picture (PGM, P5) as cells. @return null: it is none, or has more than MOST_CELLS */
export const read_cells = (bytes: Uint8Array, thinned: number): SiteCells | null => {
  if (bytes[0] !== 0x50 || bytes[1] !== 0x35) return null;
  const [figures, end] = head_of(bytes) ?? [[], 0];
  const [columns = 0, rows = 0, most = 0] = figures;
  const count = columns * rows;
  if (count === 0 || count > MOST_CELLS || most !== 255 || bytes.length - end < count) return null;
  return { columns, rows, thinned, cells: bytes.subarray(end, end + count).map(kind_of) };
};
