// The worker that cuts orthophotos into tiles, beside the page: STOP must never wait for it.
// The finest tiles out of the picture, each coarser one out of its four.

import { TILE_PX, tiles_across, type TileAddress } from '../model/tiling';
import type { Asked, Told } from './messages';
import { open_picture, type Picture } from './picture';
import { Trouble } from './trouble';
import { lattice_of, warp, window_of } from './warp';

/** The page's, but for what a worker has else. */
const page = self as unknown as {
  postMessage(told: Told): void;
  onmessage: ((event: MessageEvent<Asked>) => void) | null;
};

let picture: Picture | null = null;
let format: 'webp' | 'png' = 'png';
let taken: () => void = () => undefined;
let done = 0;

const canvas_of = (): OffscreenCanvas => new OffscreenCanvas(TILE_PX, TILE_PX);

const blob_of = (canvas: OffscreenCanvas): Promise<Blob> =>
  canvas.convertToBlob({ type: `image/${format}`, quality: 0.85 });

/** Not every browser writes it. */
const probe_format = async (): Promise<'webp' | 'png'> => {
  const canvas = canvas_of();
  canvas.getContext('2d');
  const { type } = await canvas.convertToBlob({ type: 'image/webp' });
  return type === 'image/webp' ? 'webp' : 'png';
};

const give = async (at: TileAddress, canvas: OffscreenCanvas): Promise<void> => {
  const next = new Promise<void>((resolve) => (taken = resolve));
  page.postMessage({ kind: 'tile', at, picture: await blob_of(canvas), done });
  await next;
};

const finest = async (from: Picture, at: TileAddress): Promise<OffscreenCanvas | null> => {
  done += 1;
  const lattice = lattice_of(at, from.to_picture);
  const window = window_of(lattice, from.width, from.height);
  if (!window) return null;
  const pixels = new ImageData(TILE_PX, TILE_PX);
  if (!warp(lattice, await from.read(window), pixels.data)) return null;
  const canvas = canvas_of();
  canvas.getContext('2d')?.putImageData(pixels, 0, 0);
  return canvas;
};

/** @return null: there is nothing on it */
const tile = async (from: Picture, at: TileAddress): Promise<OffscreenCanvas | null> => {
  const { bounds, max_zoom } = from.is;
  const range = tiles_across(bounds, at.z);
  if (at.x < range.west || at.x > range.east || at.y < range.north || at.y > range.south)
    return null;
  let canvas: OffscreenCanvas | null = null;
  if (at.z === max_zoom) {
    canvas = await finest(from, at);
  } else {
    for (const [dx, dy] of [
      [0, 0],
      [1, 0],
      [0, 1],
      [1, 1],
    ] as const) {
      const part = await tile(from, { z: at.z + 1, x: 2 * at.x + dx, y: 2 * at.y + dy });
      if (!part) continue;
      canvas ??= canvas_of();
      const half = TILE_PX / 2;
      canvas.getContext('2d')?.drawImage(part, dx * half, dy * half, half, half);
    }
  }
  if (canvas) await give(at, canvas);
  return canvas;
};

const cut = async (from: Picture): Promise<void> => {
  const { bounds, min_zoom } = from.is;
  const { west, east, north, south } = tiles_across(bounds, min_zoom);
  done = 0;
  for (let y = north; y <= south; y++) {
    for (let x = west; x <= east; x++) await tile(from, { z: min_zoom, x, y });
  }
  page.postMessage({ kind: 'whole' });
};

const look = async (file: Blob): Promise<void> => {
  picture = await open_picture(file);
  format = await probe_format();
  page.postMessage({ kind: 'looked', is: { ...picture.is, format } });
};

const answered = async (work: () => Promise<void>): Promise<void> => {
  try {
    await work();
  } catch (cause) {
    const detail = cause instanceof Error ? cause.message : '';
    const why = cause instanceof Trouble ? cause.why : 'unreadable';
    page.postMessage({ kind: 'trouble', why, detail });
  }
};

page.onmessage = ({ data }) => {
  if (data.kind === 'next') return taken();
  void answered(async () => {
    if (data.kind === 'look') return look(data.file);
    if (picture) return cut(picture);
  });
};
