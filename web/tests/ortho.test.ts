// Orthophotos: where they lie, by planes of the fields, and what is refused.

import { describe, expect, it } from 'vitest';

import { utm_of } from '../src/model/utm';
import { open_picture } from '../src/ortho/picture';
import { file_reader } from './file_reader';
import { geotiff, type Made } from './geotiff';

const TARTU = { lat: 58.378, lon: 26.729 };

file_reader();

const made = (more: Partial<Made> = {}): Blob =>
  new Blob([
    geotiff({
      width: 40,
      height: 20,
      color: (x, y) => [x, y, 200],
      corner: [0, 0],
      pixel: [0.5, 0.5],
      plane: 32635,
      ...more,
    }),
  ]);

const why = async (blob: Blob): Promise<unknown> => {
  try {
    await open_picture(blob);
    return 'taken';
  } catch (cause) {
    return (cause as { readonly why: string }).why;
  }
};

describe('an orthophoto', () => {
  it('lies where UTM says', async () => {
    const { east_m = 0, north_m = 0 } = utm_of(TARTU) ?? {};
    // Tartu is in its tenth column and fourth row.
    const picture = await open_picture(made({ corner: [east_m - 5, north_m + 2] }));
    const [x, y] = picture.to_picture(TARTU.lon, TARTU.lat);
    expect(x).toBeCloseTo(10, 2);
    expect(y).toBeCloseTo(4, 2);
    expect(picture.is.bounds.west).toBeLessThan(TARTU.lon);
    expect(picture.is.bounds.north).toBeGreaterThan(TARTU.lat);
    expect(picture.is.max_zoom).toBe(18); // 0.31 m a pixel; 17 has 0.63 m
  });

  it('lies where the Estonian plane says', async () => {
    // Its origin by definition: 57°31'03.19415" N, 24° E is 500 km east and 6375 km north.
    const lat = 57 + 31 / 60 + 3.19415 / 3600;
    const picture = await open_picture(made({ plane: 3301, corner: [499_990, 6_375_005] }));
    const [x, y] = picture.to_picture(24, lat);
    expect(x).toBeCloseTo(20, 1);
    expect(y).toBeCloseTo(10, 1);
  });

  it('lies where degrees say', async () => {
    const picture = await open_picture(
      made({ plane: 4326, geographic: true, corner: [26.7, 58.4], pixel: [1e-5, 5e-6] }),
    );
    const [x, y] = picture.to_picture(26.7001, 58.39995);
    expect([x, y].map((value) => Math.round(value * 1000) / 1000)).toEqual([10, 10]);
  });

  it('lies half a pixel off where its corner is the middle of a pixel', async () => {
    const { east_m = 0, north_m = 0 } = utm_of(TARTU) ?? {};
    const picture = await open_picture(made({ corner: [east_m - 5, north_m + 2], point: true }));
    const [x, y] = picture.to_picture(TARTU.lon, TARTU.lat);
    expect(x).toBeCloseTo(10.5, 2);
    expect(y).toBeCloseTo(4.5, 2);
  });

  it('tells of a datum that is not known to a metre', async () => {
    const at = { plane: 2263, codes: { 3076: 9003 }, corner: [984_250, 200_000] } as const;
    expect((await open_picture(made(at))).is.datum).toEqual({ name: 'NAD83', good_to_m: 4 });
  });

  it('gives its pixels, clear ones too', async () => {
    const picture = await open_picture(
      made({ corner: [500_000, 6_470_000], color: (x, y) => [x, y, 9, x < 2 ? 0 : 255] }),
    );
    const window = { left: 1, top: 3, right: 4, bottom: 5 };
    const { rgba } = await picture.read(window);
    expect([...rgba.slice(0, 12)]).toEqual([1, 3, 9, 0, 2, 3, 9, 255, 3, 3, 9, 255]);
    expect([...rgba.slice(12, 16)]).toEqual([1, 4, 9, 0]);
  });

  it('is refused with the reason', async () => {
    expect(await why(new Blob(['II*\0 and nothing else']))).toBe('unreadable');
    expect(await why(made({ plane: 30001, corner: [500_000, 6_470_000] }))).toBe('no_projection');
    expect(await why(made({ plane: 32035, corner: [2e6, 1e5] }))).toBe('no_datum');
    expect(await why(made({ plane: 2048, corner: [0, 0] }))).toBe('other_axes');
    expect(await why(made({ corner: [5e9, 6_470_000] }))).toBe('no_place');
    expect(await why(made({ bits: 16, corner: [500_000, 6_470_000] }))).toBe('not_8_bit');
    expect(await why(made({ pixel: [0, 0], corner: [500_000, 6_470_000] }))).toBe('no_place');
  });
});
