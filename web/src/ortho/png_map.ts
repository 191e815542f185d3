// The picture of a map as PNG (ISO 15948), made the grey one (PGM) that the robot reads: as the map server
// of Nav2 reads it (nav2_map_server, map_io), a cell is as bright as the mean of red, green and blue.

/** What is in the way of it. */
export type PngTrouble = 'png_unreadable' | 'png_interlaced' | 'png_clear' | 'png_too_large';

/** As many cells along a side as the robot takes. */
const LONGEST_SIDE = 10_000;
const MAGIC = [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a];
const GREY = 0;
const PALETTE = 3;
/** Samples of a pixel, by the kind of its colours: grey, RGB, palette, and the first two with an alpha. */
const SAMPLES: Readonly<Record<number, number>> = { [GREY]: 1, 2: 3, [PALETTE]: 1, 4: 2, 6: 4 };

interface Head {
  readonly columns: number;
  readonly rows: number;
  readonly bits: number;
  readonly kind: number;
  readonly samples: number;
}

interface Png extends Head {
  readonly packed: Uint8Array<ArrayBuffer>;
  readonly palette: Uint8Array;
  /** Of a palette: how opaque each colour is. Else: the colour that is clear. */
  readonly clear: Uint8Array | null;
}

const joined = (parts: readonly Uint8Array[]): Uint8Array<ArrayBuffer> => {
  const whole = new Uint8Array(parts.reduce((sum, { length }) => sum + length, 0));
  let at = 0;
  for (const part of parts) {
    whole.set(part, at);
    at += part.length;
  }
  return whole;
};

const chunks_of = (bytes: Uint8Array): Map<string, Uint8Array[]> | null => {
  if (MAGIC.some((byte, k) => bytes[k] !== byte)) return null;
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const found = new Map<string, Uint8Array[]>();
  for (let at = 8; at + 12 <= bytes.length;) {
    const size = view.getUint32(at);
    if (at + 12 + size > bytes.length) return null;
    const name = String.fromCharCode(...bytes.subarray(at + 4, at + 8));
    const own = bytes.subarray(at + 8, at + 8 + size);
    found.set(name, [...(found.get(name) ?? []), own]);
    at += 12 + size;
  }
  return found;
};

const png_of = (bytes: Uint8Array): Png | PngTrouble => {
  const chunks = chunks_of(bytes);
  const head = chunks?.get('IHDR')?.[0];
  if (!chunks || !head || head.length < 13) return 'png_unreadable';
  const view = new DataView(head.buffer, head.byteOffset, head.byteLength);
  const [columns, rows] = [view.getUint32(0), view.getUint32(4)];
  const [bits = 0, kind = 0, , , interlaced] = head.subarray(8);
  const samples = SAMPLES[kind];
  if (samples === undefined || ![1, 2, 4, 8, 16].includes(bits)) return 'png_unreadable';
  if (columns === 0 || rows === 0) return 'png_unreadable';
  if (Math.max(columns, rows) > LONGEST_SIDE) return 'png_too_large';
  if (interlaced !== 0) return 'png_interlaced';
  const packed = joined(chunks.get('IDAT') ?? []);
  const palette = chunks.get('PLTE')?.[0] ?? new Uint8Array();
  return {
    columns,
    rows,
    bits,
    kind,
    samples,
    packed,
    palette,
    clear: chunks.get('tRNS')?.[0] ?? null,
  };
};

/** What comes out of the packed bytes, row by row. */
async function* rows_of({ columns, bits, samples, packed }: Png): AsyncGenerator<Uint8Array> {
  const step = Math.max(1, (samples * bits) >> 3);
  const size = Math.ceil((columns * samples * bits) / 8);
  let above = new Uint8Array(size);
  let rest: Uint8Array = new Uint8Array();
  const reader = new Blob([packed])
    .stream()
    .pipeThrough(new DecompressionStream('deflate'))
    .getReader();
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    rest = joined([rest, part.value]);
    let at = 0;
    for (; at + 1 + size <= rest.length; at += 1 + size) {
      const row = Uint8Array.from(rest.subarray(at + 1, at + 1 + size));
      unfilter(rest[at] ?? 0, row, above, step);
      yield row;
      above = row;
    }
    rest = rest.subarray(at);
  }
}

const nearest = (left: number, up: number, corner: number): number => {
  const guess = left + up - corner;
  const [a, b, c] = [Math.abs(guess - left), Math.abs(guess - up), Math.abs(guess - corner)];
  return a <= b && a <= c ? left : b <= c ? up : corner;
};

/** Each byte was kept as its difference to those before. */
const unfilter = (filter: number, row: Uint8Array, above: Uint8Array, step: number): void => {
  for (let k = 0; k < row.length; k++) {
    const left = row[k - step] ?? 0;
    const up = above[k] ?? 0;
    const guesses = [0, left, up, (left + up) >> 1];
    const guess = filter === 4 ? nearest(left, up, above[k - step] ?? 0) : (guesses[filter] ?? 0);
    row[k] = (row[k] ?? 0) + guess;
  }
};

/** The samples of a row, 0 to the greatest of its bits. */
const sample_of = (row: Uint8Array, bits: number, k: number): number => {
  if (bits === 8) return row[k] ?? 0;
  if (bits === 16) return 256 * (row[2 * k] ?? 0) + (row[2 * k + 1] ?? 0);
  const bit = k * bits;
  return ((row[bit >> 3] ?? 0) >> (8 - bits - (bit & 7))) & (2 ** bits - 1);
};

/** Red, green, blue and how opaque, 0 to 1, into what is kept for every pixel. */
const read_color = (png: Png, row: Uint8Array, column: number, into: Float64Array): void => {
  const { bits, kind, samples, palette, clear } = png;
  const greatest = 2 ** bits - 1;
  const from = column * samples;
  const first = sample_of(row, bits, from);
  if (kind === PALETTE) {
    for (let k = 0; k < 3; k++) into[k] = (palette[3 * first + k] ?? 0) / 255;
    into[3] = (clear?.[first] ?? 255) / 255;
    return;
  }
  const colors = samples < 3 ? 1 : 3;
  let named = clear !== null;
  for (let k = 0; k < 3; k++) {
    const value = k < colors ? sample_of(row, bits, from + k) : first;
    into[k] = value / greatest;
    named &&= k >= colors || (clear !== null && value === sample_of(clear, 16, k));
  }
  into[3] = samples > colors ? sample_of(row, bits, from + colors) / greatest : named ? 0 : 1;
};

/** STOP must never wait for it. */
const breath = (): Promise<void> => new Promise((resolve) => setTimeout(resolve));
const CELLS_A_BREATH = 50_000;

/**
 * @param trinary whether the map is read so: then what is clear darkens a cell, as one of four parts; in the
 * other modes it would be unknown, which a grey picture cannot say
 */
export const pgm_of_png = async (
  bytes: Uint8Array,
  trinary: boolean,
): Promise<Uint8Array<ArrayBuffer> | PngTrouble> => {
  const png = png_of(bytes);
  if (typeof png === 'string') return png;
  const { columns, rows, kind, clear } = png;
  const has_alpha = kind >= 4 || clear !== null;
  const as_it_is = kind === GREY && png.bits === 8 && !has_alpha;
  const cells = new Uint8Array(columns * rows);
  const color = new Float64Array(4);
  let y = 0;
  let breathed = 0;
  try {
    for await (const row of rows_of(png)) {
      if (y === rows) break;
      if (as_it_is) cells.set(row, y * columns);
      for (let x = 0; x < columns && !as_it_is; x++) {
        read_color(png, row, x, color);
        const [r = 0, g = 0, b = 0, opaque = 1] = color;
        if (!trinary && opaque < 1) return 'png_clear';
        const shade = trinary && has_alpha ? (r + g + b + opaque) / 4 : (r + g + b) / 3;
        cells[y * columns + x] = Math.round(255 * shade);
      }
      y += 1;
      if (y * columns < breathed + CELLS_A_BREATH) continue;
      breathed = y * columns;
      await breath();
    }
  } catch {
    return 'png_unreadable';
  }
  if (y < rows) return 'png_unreadable';
  return joined([new TextEncoder().encode(`P5\n${columns} ${rows}\n255\n`), cells]);
};
