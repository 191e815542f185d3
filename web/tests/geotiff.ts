// A GeoTIFF by its specifications (TIFF 6.0; OGC 19-008r4): one strip, nothing packed, RGB or RGBA.

export interface Made {
  readonly width: number;
  readonly height: number;
  /** Red, green, blue and perhaps alpha. */
  readonly color: (x: number, y: number) => readonly number[];
  /** Of the upper left corner: east and north, or longitude and latitude. */
  readonly corner: readonly [number, number];
  readonly pixel: readonly [number, number];
  /** An EPSG code. */
  readonly plane: number;
  readonly geographic?: boolean;
  readonly bits?: number;
}

const SHORT = 3;
const LONG = 4;
const DOUBLE = 12;
const SIZE = { [SHORT]: 2, [LONG]: 4, [DOUBLE]: 8 } as const;
type Kind = keyof typeof SIZE;

export const geotiff = (made: Made): Uint8Array<ArrayBuffer> => {
  const { width, height, corner, pixel, plane, geographic = false, bits = 8 } = made;
  const samples = made.color(0, 0).length;
  const pixels = new Uint8Array(width * height * samples);
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) pixels.set(made.color(x, y), (y * width + x) * samples);
  }
  const tags: [tag: number, kind: Kind, values: readonly number[]][] = [
    [256, LONG, [width]],
    [257, LONG, [height]],
    [258, SHORT, Array<number>(samples).fill(bits)],
    [259, SHORT, [1]], // not packed
    [262, SHORT, [2]], // RGB
    [273, LONG, [8]], // the strip begins after the header
    [277, SHORT, [samples]],
    [278, LONG, [height]],
    [279, LONG, [pixels.length]],
    ...(samples > 3 ? ([[338, SHORT, [2]]] as [number, Kind, number[]][]) : []),
    [33550, DOUBLE, [pixel[0], pixel[1], 0]],
    [33922, DOUBLE, [0, 0, 0, corner[0], corner[1], 0]],
    // Version 1.1, three keys: the model, pixels are areas, and the code.
    [
      34735,
      SHORT,
      [
        1,
        1,
        0,
        3,
        1024,
        0,
        1,
        geographic ? 2 : 1,
        1025,
        0,
        1,
        1,
        geographic ? 2048 : 3072,
        0,
        1,
        plane,
      ],
    ],
  ];
  const directory = 8 + pixels.length + (pixels.length % 2);
  let far = directory + 2 + 12 * tags.length + 4;
  const bytes = new Uint8Array(far + 400);
  const view = new DataView(bytes.buffer);
  bytes.set([0x49, 0x49, 42, 0]);
  view.setUint32(4, directory, true);
  bytes.set(pixels, 8);
  view.setUint16(directory, tags.length, true);
  const write = (at: number, kind: Kind, value: number): void => {
    if (kind === SHORT) view.setUint16(at, value, true);
    else if (kind === LONG) view.setUint32(at, value, true);
    else view.setFloat64(at, value, true);
  };
  for (const [k, [tag, kind, values]] of tags.entries()) {
    const at = directory + 2 + 12 * k;
    view.setUint16(at, tag, true);
    view.setUint16(at + 2, kind, true);
    view.setUint32(at + 4, values.length, true);
    const inside = values.length * SIZE[kind] <= 4;
    const begin = inside ? at + 8 : far;
    if (!inside) view.setUint32(at + 8, far, true);
    values.forEach((value, n) => write(begin + n * SIZE[kind], kind, value));
    if (!inside) far += values.length * SIZE[kind];
  }
  return bytes.slice(0, far);
};
