// A GeoTIFF: where it lies, and its pixels.

import { fromBlob, type GeoTIFF, type GeoTIFFImage } from 'geotiff';

import { tiles_across, count_of, zoom_for, type Bounds } from '../model/tiling';
import type { Looked } from './messages';
import { reader_of, type PixelReader } from './pixels';
import { plane_of, type Keys } from './plane';
import { Trouble } from './trouble';
import { to_pixels, type Affine, type ToPicture } from './warp';

const MOST_ZOOM = 24;
const MOST_TILES = 200_000;
/** The coarsest zoom: all of it on so few tiles. */
const FEW_TILES = 4;

export interface Picture {
  readonly width: number;
  readonly height: number;
  readonly to_picture: ToPicture;
  readonly is: Omit<Looked, 'format'>;
  readonly read: PixelReader;
}

const PIXEL_IS_POINT = 2;

/** From the corners of the pixels. */
const affine_of = (image: GeoTIFFImage, keys: Keys): Affine => {
  const said = said_affine(image);
  if (keys.GTRasterTypeGeoKey !== PIXEL_IS_POINT) return said;
  // It is said from the middle of the first pixel.
  const { a, b, d, e } = said;
  return { ...said, c: said.c - (a + b) / 2, f: said.f - (d + e) / 2 };
};

const said_affine = (image: GeoTIFFImage): Affine => {
  const m: unknown = image.fileDirectory.getValue('ModelTransformation');
  if (Array.isArray(m) || ArrayBuffer.isView(m)) {
    const [a = 0, b = 0, , c = 0, d = 0, e = 0, , f = 0] = m as unknown as number[];
    return { a, b, c, d, e, f };
  }
  try {
    const [ox = 0, oy = 0] = image.getOrigin();
    const [sx = 0, sy = 0] = image.getResolution();
    const [i = 0, j = 0] = Array.from(
      (image.fileDirectory.getValue('ModelTiepoint') ?? []) as ArrayLike<number>,
    );
    return { a: sx, b: 0, c: ox - sx * i, d: 0, e: sy, f: oy - sy * j };
  } catch {
    throw new Trouble('no_place');
  }
};

/** Around its edges: a picture may be turned. */
const bounds_of = (
  image: GeoTIFFImage,
  place: (px: number, py: number) => [number, number],
): Bounds => {
  const width = image.getWidth();
  const height = image.getHeight();
  const lons: number[] = [];
  const lats: number[] = [];
  for (let k = 0; k <= 8; k++) {
    const share = k / 8;
    const edges = [
      [share * width, 0],
      [share * width, height],
      [0, share * height],
      [width, share * height],
    ] as const;
    for (const [px, py] of edges) {
      const [lon, lat] = place(px, py);
      lons.push(lon);
      lats.push(lat);
    }
  }
  const bounds = {
    west: Math.min(...lons),
    south: Math.min(...lats),
    east: Math.max(...lons),
    north: Math.max(...lats),
  };
  const { west, south, east, north } = bounds;
  if (!(west >= -180 && east <= 180 && south >= -85 && north <= 85 && west < east)) {
    throw new Trouble('no_place');
  }
  return bounds;
};

const zooms_of = (
  bounds: Bounds,
  m_per_px: number,
): Pick<Looked, 'min_zoom' | 'max_zoom' | 'tiles'> => {
  const max_zoom = zoom_for(m_per_px, (bounds.south + bounds.north) / 2, MOST_ZOOM);
  const tiles = count_of(tiles_across(bounds, max_zoom));
  if (tiles > MOST_TILES) throw new Trouble('too_large', String(tiles));
  let min_zoom = max_zoom;
  while (min_zoom > 0 && count_of(tiles_across(bounds, min_zoom)) > FEW_TILES) min_zoom -= 1;
  return { min_zoom, max_zoom, tiles };
};

const keys_of = (image: GeoTIFFImage): Keys => {
  const keys: unknown = image.getGeoKeys();
  if (keys === null || typeof keys !== 'object') throw new Trouble('no_place');
  return keys as Keys;
};

/** @throws Trouble */
export const open_picture = async (from: Blob): Promise<Picture> => {
  let file: GeoTIFF;
  let image: GeoTIFFImage;
  try {
    file = await fromBlob(from);
    image = await file.getImage();
  } catch (cause) {
    throw new Trouble('unreadable', cause instanceof Error ? cause.message : '');
  }
  const read = await reader_of(file, image);
  const width = image.getWidth();
  const height = image.getHeight();
  const keys = keys_of(image);
  const affine = affine_of(image, keys);
  const pixels = to_pixels(affine);
  if (!pixels) throw new Trouble('no_place');
  const on_plane = (px: number, py: number): [number, number] => [
    affine.a * px + affine.b * py + affine.c,
    affine.d * px + affine.e * py + affine.f,
  ];
  const plane = plane_of(keys, on_plane(width / 2, height / 2));
  const bounds = bounds_of(image, (px, py) => plane.inverse(...on_plane(px, py)));
  // Of its diagonal: pixels may be no squares.
  const across_m = Math.hypot(
    (bounds.east - bounds.west) * 111_320 * Math.cos((bounds.south * Math.PI) / 180),
    (bounds.north - bounds.south) * 111_320,
  );
  const zooms = zooms_of(bounds, across_m / Math.hypot(width, height));
  const { datum } = plane;
  return {
    width,
    height,
    to_picture: (lon, lat) => pixels(...plane.forward(lon, lat)),
    is: { bounds, datum, ...zooms },
    read,
  };
};
