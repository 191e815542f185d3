// The picture of a map as the robot reads it.

import { say } from '../model/say';
import type { MapFiles } from '../model/site_map';
import { pgm_of_png } from './png_map';

const PNG = /\.png$/i;

/** With a grey picture (PGM) instead of a PNG. @return what is in the way, in words */
export const for_robot = async (files: MapFiles): Promise<MapFiles | string> => {
  if ('cloud' in files || !PNG.test(files.image.name)) return files;
  const mode = /^\s*mode:\s*["']?(\w+)/m.exec(await files.yaml.text())?.[1] ?? 'trinary';
  const png = new Uint8Array(await files.image.arrayBuffer());
  const pgm = await pgm_of_png(png, mode === 'trinary');
  if (typeof pgm === 'string') return say(pgm);
  const image = new File([pgm], files.image.name.replace(PNG, '.pgm'));
  return { yaml: files.yaml, image };
};
