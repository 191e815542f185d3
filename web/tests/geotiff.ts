// A GeoTIFF by its specifications (TIFF 6.0; OGC 19-008r4): one strip, nothing packed, grey or colours.

export interface Made {
  readonly width: number;
  readonly height: number;
  /** Of each sample of a pixel: grey, or red, green, blue; and what else there is. */
  readonly color: (x: number, y: number) => readonly number[];
  /** Of the upper left corner: east and north, or longitude and latitude. */
  readonly corner: readonly [number, number];
  readonly pixel: readonly [number, number];
  /** An EPSG code. */
  readonly plane: number;
  readonly geographic?: boolean;
  /** The corner is that of the first pixel's middle. */
  readonly point?: boolean;
  readonly bits?: number;
  /** Usual: RGB of three samples and more, else black is 0. */
  readonly photometric?: number;
  /** What the last samples are; usual: of four the last one is how opaque. */
  readonly extra?: readonly number[];
  /** Where there is something: kept as a picture of its own. */
  readonly mask?: (x: number, y: number) => boolean;
  /** More keys, by their numbers. */
  readonly codes?: Readonly<Record<number, number>>;
  readonly doubles?: Readonly<Record<number, readonly number[]>>;
}

const SHORT = 3;
const LONG = 4;
const DOUBLE = 12;
const SIZE = { [SHORT]: 2, [LONG]: 4, [DOUBLE]: 8 } as const;
type Kind = keyof typeof SIZE;
type Tag = readonly [tag: number, kind: Kind, values: readonly number[]];

const DOUBLES = 34736;

/** Version 1.1, by rising numbers: the model, what a pixel is, the code, and more. */
const keys_of = (made: Made): Tag[] => {
  const doubles = Object.entries(made.doubles ?? {});
  const codes: Record<number, number> = {
    1024: made.geographic ? 2 : 1,
    1025: made.point ? 2 : 1,
    [made.geographic ? 2048 : 3072]: made.plane,
    ...made.codes,
  };
  const rows = Object.entries(codes).map(([key, code]) => [Number(key), 0, 1, code]);
  const values: number[] = [];
  for (const [key, own] of doubles) {
    rows.push([Number(key), DOUBLES, own.length, values.length]);
    values.push(...own);
  }
  rows.sort(([one = 0], [other = 0]) => one - other);
  const tags: Tag[] = [[34735, SHORT, [1, 1, 0, rows.length, ...rows.flat()]]];
  return values.length === 0 ? tags : [...tags, [DOUBLES, DOUBLE, values]];
};

/** Of one bit a sample: eight to a byte, each row from a byte on. */
const packed = (made: Made, color: Made['color'], bits: number): Uint8Array => {
  const { width, height } = made;
  const samples = color(0, 0).length;
  const row = bits === 1 ? Math.ceil(width / 8) : width * samples;
  const bytes = new Uint8Array(row * height);
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      if (bits !== 1) bytes.set(color(x, y), y * row + x * samples);
      else if (color(x, y)[0]) {
        const at = y * row + (x >> 3);
        bytes[at] = (bytes[at] ?? 0) | (0x80 >> (x & 7));
      }
    }
  }
  return bytes;
};

const picture = (made: Made, color: Made['color'], bits: number, photometric: number): Tag[] => {
  const samples = color(0, 0).length;
  return [
    [256, LONG, [made.width]],
    [257, LONG, [made.height]],
    [258, SHORT, Array<number>(samples).fill(bits)],
    [259, SHORT, [1]], // not packed
    [262, SHORT, [photometric]],
    [273, LONG, [0]], // where its strip begins: known when it is laid
    [277, SHORT, [samples]],
    [278, LONG, [made.height]],
    [279, LONG, [packed(made, color, bits).length]],
  ];
};

/** One after the other: its pixels, its directory, and what is too long for that. */
const laid = (parts: readonly { pixels: Uint8Array; tags: Tag[] }[]): Uint8Array<ArrayBuffer> => {
  const bytes = new Uint8Array(
    8 + parts.reduce((sum, { pixels }) => sum + pixels.length + 1200, 0),
  );
  const view = new DataView(bytes.buffer);
  const write = (at: number, kind: Kind, value: number): void => {
    if (kind === SHORT) view.setUint16(at, value, true);
    else if (kind === LONG) view.setUint32(at, value, true);
    else view.setFloat64(at, value, true);
  };
  bytes.set([0x49, 0x49, 42, 0]);
  let next = 4; // where the place of the next directory is said
  let far = 8;
  for (const { pixels, tags } of parts) {
    const strip = far;
    bytes.set(pixels, strip);
    const directory = strip + pixels.length + (pixels.length % 2);
    view.setUint32(next, directory, true);
    view.setUint16(directory, tags.length, true);
    next = directory + 2 + 12 * tags.length;
    far = next + 4;
    for (const [k, [tag, kind, values]] of tags.entries()) {
      const at = directory + 2 + 12 * k;
      view.setUint16(at, tag, true);
      view.setUint16(at + 2, kind, true);
      view.setUint32(at + 4, values.length, true);
      const inside = values.length * SIZE[kind] <= 4;
      const begin = inside ? at + 8 : far;
      if (!inside) view.setUint32(at + 8, far, true);
      const own = tag === 273 ? [strip] : values;
      own.forEach((value, n) => write(begin + n * SIZE[kind], kind, value));
      if (!inside) far += values.length * SIZE[kind];
    }
  }
  return bytes.slice(0, far);
};

export const geotiff = (made: Made): Uint8Array<ArrayBuffer> => {
  const { corner, pixel, bits = 8, mask } = made;
  const samples = made.color(0, 0).length;
  const extra = made.extra ?? (samples > 3 ? [2] : []);
  const tags: Tag[] = [
    ...picture(made, made.color, bits, made.photometric ?? (samples > 2 ? 2 : 1)),
    ...(extra.length > 0 ? ([[338, SHORT, extra]] as Tag[]) : []),
    [33550, DOUBLE, [pixel[0], pixel[1], 0]],
    [33922, DOUBLE, [0, 0, 0, corner[0], corner[1], 0]],
    ...keys_of(made),
  ];
  const parts = [{ pixels: packed(made, made.color, bits), tags }];
  if (mask) {
    const seen = (x: number, y: number): number[] => [Number(mask(x, y))];
    const own: Tag[] = [[254, LONG, [4]], ...picture(made, seen, 1, 4)];
    parts.push({ pixels: packed(made, seen, 1), tags: own });
  }
  return laid(parts);
};
