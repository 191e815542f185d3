import { expect, test } from 'vitest';

import { PIECE, pieces_of, type Piece } from '../src/model/pieces';

const area = (pieces: readonly Piece[]): number =>
  pieces.reduce((sum, { width, height }) => sum + width * height, 0);

test('a small picture is one piece', () => {
  expect(pieces_of(390.5, 300, 2)).toEqual([
    { left: 0, top: 0, right: 390.5, bottom: 300, width: 781, height: 600 },
  ]);
});

test.each([
  [1824, 1284, 1],
  [624, 1078, 3],
  [1001, 721, 1.5],
  [961, 1, 1],
])('%i x %i pixels at %f are covered once, by pieces that a frame has time for', (w, h, ratio) => {
  const pieces = pieces_of(w, h, ratio);
  const [width, height] = [Math.ceil(w * ratio), Math.ceil(h * ratio)];
  expect(area(pieces)).toBe(width * height);
  for (const piece of pieces) {
    expect(piece.width).toBeGreaterThan(0);
    expect(piece.width).toBeLessThanOrEqual(PIECE.width);
    expect(piece.height).toBeLessThanOrEqual(PIECE.height);
    // Between two pixels of the device: no line of a piece is blurred.
    expect(Number.isInteger(Math.round(piece.left * ratio * 1e6) / 1e6)).toBe(true);
    expect((piece.right - piece.left) * ratio).toBeCloseTo(piece.width);
  }
  expect(Math.max(...pieces.map(({ right }) => right))).toBeCloseTo(width / ratio);
  expect(Math.max(...pieces.map(({ bottom }) => bottom))).toBeCloseTo(height / ratio);
});
