// A large picture in pieces, each of which is drawn within a frame.

/** A part of a picture: where it lies, in its pixels, and how large it is in the device's own. */
export interface Piece {
  readonly left: number;
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
  readonly width: number;
  readonly height: number;
}

/** No piece is larger, in the device's own pixels. */
export const PIECE = { width: 960, height: 720 } as const;

interface Stretch {
  readonly from: number;
  readonly length: number;
}

/** In as few as there can be, alike but for the last. */
const stretches = (length: number, most: number): Stretch[] => {
  const count = Math.max(1, Math.ceil(length / most));
  const each = Math.ceil(length / count);
  return Array.from({ length: count }, (_, k) => ({
    from: k * each,
    length: Math.min(each, length - k * each),
  }));
};

/** @param ratio the device's own pixels to one pixel; pieces meet between two of them */
export const pieces_of = (width_px: number, height_px: number, ratio: number): Piece[] => {
  const across = stretches(Math.ceil(width_px * ratio), PIECE.width);
  const down = stretches(Math.ceil(height_px * ratio), PIECE.height);
  return down.flatMap((row) =>
    across.map((column) => ({
      left: column.from / ratio,
      top: row.from / ratio,
      right: (column.from + column.length) / ratio,
      bottom: (row.from + row.length) / ratio,
      width: column.length,
      height: row.length,
    })),
  );
};
