// Maps as PNG: by its specification (ISO 15948), and as Nav2's map server reads them.

import { expect, it } from 'vitest';

import { pgm_of_png } from '../src/ortho/png_map';

interface Made {
  readonly bits?: number;
  readonly kind?: number;
  readonly interlaced?: number;
  /** Other chunks, by their names. */
  readonly more?: Readonly<Record<string, readonly number[]>>;
}

const chunk = (name: string, body: readonly number[]): number[] => {
  const size = [24, 16, 8, 0].map((shift) => (body.length >> shift) & 0xff);
  // The checksum is not looked at.
  return [...size, ...new TextEncoder().encode(name), ...body, 0, 0, 0, 0];
};

/** @param rows with the filter of each before its bytes */
const png = async (
  columns: number,
  rows: readonly (readonly number[])[],
  made: Made = {},
): Promise<Uint8Array> => {
  const { bits = 8, kind = 0, interlaced = 0, more = {} } = made;
  const head = [0, 0, 0, columns, 0, 0, 0, rows.length, bits, kind, 0, 0, interlaced];
  const raw = new Blob([Uint8Array.from(rows.flat())]).stream();
  const deflated = new Response(raw.pipeThrough(new CompressionStream('deflate')));
  const packed = [...new Uint8Array(await deflated.arrayBuffer())];
  return Uint8Array.from([
    ...[0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a],
    ...chunk('IHDR', head),
    ...Object.entries(more).flatMap(([name, body]) => chunk(name, body)),
    // In two parts: where it is cut means nothing.
    ...chunk('IDAT', packed.slice(0, 5)),
    ...chunk('IDAT', packed.slice(5)),
    ...chunk('IEND', []),
  ]);
};

const cells = async (bytes: Uint8Array | Promise<Uint8Array>, trinary = true): Promise<unknown> => {
  const read = await pgm_of_png(await bytes, trinary);
  if (typeof read === 'string') return read;
  const text = new TextDecoder('latin1').decode(read);
  const head = /^P5\n\d+ \d+\n255\n/.exec(text)?.[0] ?? '';
  return [...read.slice(head.length)];
};

it('is grey as it is, by each of its filters', async () => {
  const rows = [
    [0, 10, 20, 30],
    [1, 10, 10, 10], // to the left
    [2, 5, 5, 5], // above
    [3, 100, 100, 100], // the mean of both
    [4, 1, 1, 1], // the nearest of three
  ];
  const third = [15, 25, 35];
  const fourth = [107, 166, 200];
  expect(await cells(png(3, rows))).toEqual([
    ...[10, 20, 30],
    ...[10, 20, 30],
    ...third,
    ...fourth,
    ...[108, 167, 201],
  ]);
});

it('is the mean of its colours, and of how opaque it is where that is kept', async () => {
  expect(await cells(png(2, [[0, 30, 60, 90, 0, 0, 255]], { kind: 2 }))).toEqual([60, 85]);
  // Black and clear; black; white.
  const grey = png(3, [[0, 0, 0, 0, 255, 255, 255]], { kind: 4 });
  expect(await cells(grey)).toEqual([0, 64, 255]);
  expect(await cells(png(1, [[0, 100, 100, 100, 0]], { kind: 6 }))).toEqual([75]);
});

it('is read of fewer bits and of more, and by a palette', async () => {
  expect(await cells(png(9, [[0, 0b10100000, 0x80]], { bits: 1 }))).toEqual([
    ...[255, 0, 255, 0, 0, 0, 0, 0],
    255,
  ]);
  expect(await cells(png(2, [[0, 0x0f]], { bits: 4 }))).toEqual([0, 255]);
  expect(await cells(png(1, [[0, 0x80, 0x80]], { bits: 16 }))).toEqual([128]);
  const more = { PLTE: [0, 0, 0, 205, 205, 205] };
  expect(await cells(png(2, [[0, 0, 1]], { kind: 3, more }))).toEqual([0, 205]);
});

it('is refused where clear cells are unknown ones, which grey cannot say', async () => {
  const clear = png(1, [[0, 100, 0]], { kind: 4 });
  expect(await cells(clear, false)).toBe('png_clear');
  expect(await cells(png(1, [[0, 100, 255]], { kind: 4 }), false)).toEqual([100]);
  expect(await cells(png(1, [[0, 7]], { more: { tRNS: [0, 7] } }), false)).toBe('png_clear');
});

it('is refused where it cannot be read', async () => {
  expect(await cells(png(1, [[0, 1]], { interlaced: 1 }))).toBe('png_interlaced');
  expect(await cells(Uint8Array.from([0x50, 0x35]))).toBe('png_unreadable');
  expect(await cells(png(3, [[0, 1]]))).toBe('png_unreadable');
  expect(await cells((await png(2, [[0, 1, 2]])).slice(0, 60))).toBe('png_unreadable');
});
