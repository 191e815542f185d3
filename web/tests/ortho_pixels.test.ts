// The pixels of orthophotos: which sample is what, and what is clear (TIFF 6.0).

import { expect, it } from 'vitest';

import { open_picture } from '../src/ortho/picture';
import { file_reader } from './file_reader';
import { geotiff, type Made } from './geotiff';

file_reader();

/** Red, green, blue and how opaque, of the first row. */
const row_of = async (color: Made['color'], more: Partial<Made> = {}): Promise<number[][]> => {
  const made = geotiff({
    width: 3,
    height: 2,
    color,
    corner: [500_000, 6_470_000],
    pixel: [0.5, 0.5],
    plane: 32635,
    ...more,
  });
  const picture = await open_picture(new Blob([made]));
  const { rgba } = await picture.read({ left: 0, top: 0, right: 3, bottom: 1 });
  return [0, 4, 8].map((from) => [...rgba.slice(from, from + 4)]);
};

it('are clear where a mask says that there is nothing', async () => {
  expect(await row_of((x) => [10 * x, 20, 30], { mask: (x) => x !== 1 })).toEqual([
    [0, 20, 30, 255],
    [10, 20, 30, 0],
    [20, 20, 30, 255],
  ]);
});

it('are as opaque as grey with an alpha says', async () => {
  expect(await row_of((x) => [40 + x, 100 * x], { extra: [2] })).toEqual([
    [40, 40, 40, 0],
    [41, 41, 41, 100],
    [42, 42, 42, 200],
  ]);
  // One that is no alpha says nothing.
  expect((await row_of((x) => [40, 100 * x], { extra: [0] }))[0]).toEqual([40, 40, 40, 255]);
});

it('are brightened where their colours are darker by what is clear', async () => {
  const [, half] = await row_of(() => [50, 100, 25, 128], { extra: [1] });
  expect(half).toEqual([100, 199, 50, 128]);
});

it('are colours of three bands and more, as whatever they are declared', async () => {
  const bands = await row_of((x) => [x, 2, 3, 60], { photometric: 1, extra: [0, 0, 0] });
  expect(bands[2]).toEqual([2, 2, 3, 255]);
});

it('are black and white of one bit, either way round', async () => {
  const color = (x: number): number[] => [x === 1 ? 1 : 0];
  const grey = (row: number[][]): unknown => row.map(([value]) => value);
  expect(grey(await row_of(color, { bits: 1 }))).toEqual([0, 255, 0]);
  expect(grey(await row_of(color, { bits: 1, photometric: 0 }))).toEqual([255, 0, 255]);
  expect(grey(await row_of((x) => [x], { photometric: 0 }))).toEqual([255, 254, 253]);
});
