// A GeoTIFF's pixels as red, green, blue and how opaque (TIFF 6.0).

import type { GeoTIFF, GeoTIFFImage } from 'geotiff';

import { Trouble } from './trouble';
import type { PictureWindow, Pixels } from './warp';

const WHITE_IS_ZERO = 0;
const BLACK_IS_ZERO = 1;
const RGB = 2;
const MASK = 4;
const ASSOCIATED_ALPHA = 1;
const UNASSOCIATED_ALPHA = 2;

/** Which samples of a pixel are what. */
interface Layout {
  /** One: grey. Three: red, green, blue. None: as the library says (palettes, YCbCr, CMYK, Lab). */
  readonly colors: readonly number[];
  readonly alpha: number | null;
  /** Colours are darker by what is clear. */
  readonly associated: boolean;
  readonly white_is_zero: boolean;
  /** What a sample is multiplied with, to reach from 0 to 255. */
  readonly scale: number;
}

const layout_of = (image: GeoTIFFImage): Layout => {
  const bits = image.getBitsPerSample(0);
  if (bits !== 8 && bits !== 1) throw new Trouble('not_8_bit', String(bits));
  const model = image.fileDirectory.getValue('PhotometricInterpretation');
  const samples = image.getSamplesPerPixel();
  const extra = Array.from(image.fileDirectory.getValue('ExtraSamples') ?? []);
  const at = extra.findIndex((kind) => kind === ASSOCIATED_ALPHA || kind === UNASSOCIATED_ALPHA);
  const plain = model === WHITE_IS_ZERO || model === BLACK_IS_ZERO || model === RGB;
  // Pictures of three bands and more are colours, as which ones they may be declared.
  const alpha = at < 0 ? null : samples - extra.length + at;
  const bands = alpha === null ? samples : alpha;
  return {
    colors: !plain ? [] : bands >= 3 ? [0, 1, 2] : [0],
    alpha: plain ? alpha : null,
    associated: extra[at] === ASSOCIATED_ALPHA,
    white_is_zero: model === WHITE_IS_ZERO,
    scale: bits === 1 ? 255 : 1,
  };
};

/** The picture of what is seen of another one: the same pixels, 0 where there is nothing. */
const mask_of = async (file: GeoTIFF, image: GeoTIFFImage): Promise<GeoTIFFImage | null> => {
  const count = await file.getImageCount();
  for (let k = 1; k < count; k++) {
    const other = await file.getImage(k);
    const same = other.getWidth() === image.getWidth() && other.getHeight() === image.getHeight();
    const kind = other.fileDirectory.getValue('NewSubfileType') ?? 0;
    if (same && typeof kind === 'number' && (kind & MASK) !== 0) return other;
  }
  return null;
};

const samples_of = async (
  image: GeoTIFFImage,
  { left, top, right, bottom }: PictureWindow,
  samples: readonly number[],
): Promise<ArrayLike<number>> => {
  const window = [left, top, right, bottom];
  const raw: unknown =
    samples.length === 0
      ? await image.readRGB({ window, interleave: true })
      : await image.readRasters({ window, interleave: true, samples: [...samples] });
  return raw as ArrayLike<number>;
};

/** With the alpha that it has, and clear where it says that there is nothing. */
const colored = (
  { colors, alpha, associated, white_is_zero, scale }: Layout,
  nothing: number | null,
  raw: ArrayLike<number>,
  rgba: Uint8ClampedArray,
): void => {
  const stride = (colors.length === 0 ? 3 : colors.length) + (alpha === null ? 0 : 1);
  for (let k = 0; k < rgba.length / 4; k++) {
    const from = k * stride;
    const first = raw[from] ?? 0;
    const own = colors.length === 1 ? [first, first, first] : [first, raw[from + 1], raw[from + 2]];
    const opaque = alpha === null ? 255 : (raw[from + stride - 1] ?? 0) * scale;
    const brighter = associated && opaque > 0 ? 255 / opaque : 1;
    own.forEach((value = 0, at) => {
      rgba[4 * k + at] = (white_is_zero ? 255 - value * scale : value * scale) * brighter;
    });
    rgba[4 * k + 3] = own.every((value) => value === nothing) ? 0 : opaque;
  }
};

export type PixelReader = (window: PictureWindow) => Promise<Pixels>;

/** @throws Trouble its colours are none of those that are known */
export const reader_of = async (file: GeoTIFF, image: GeoTIFFImage): Promise<PixelReader> => {
  const layout = layout_of(image);
  const wanted = layout.alpha === null ? layout.colors : [...layout.colors, layout.alpha];
  const mask = await mask_of(file, image);
  const nothing = image.getGDALNoData();
  return async (window) => {
    const count = (window.right - window.left) * (window.bottom - window.top);
    const rgba = new Uint8ClampedArray(4 * count);
    colored(layout, nothing, await samples_of(image, window, wanted), rgba);
    if (mask) {
      const seen = await samples_of(mask, window, [0]);
      for (let k = 0; k < count; k++) if (seen[k] === 0) rgba[4 * k + 3] = 0;
    }
    return { window, rgba };
  };
};
