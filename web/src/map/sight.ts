// What of the plane is in sight, and which part of the window is free for it.

import type { LatLon } from '../model/plan';
import type { Cover } from './grid';
import { to_plane } from './projection';

export const extent_of = (points: readonly LatLon[]): [number, number, number, number] => {
  const extent: [number, number, number, number] = [Infinity, Infinity, -Infinity, -Infinity];
  for (const point of points) {
    const [x, y] = to_plane(point);
    extent[0] = Math.min(extent[0], x);
    extent[1] = Math.min(extent[1], y);
    extent[2] = Math.max(extent[2], x);
    extent[3] = Math.max(extent[3], y);
  }
  return extent;
};

/** The part of the map that no panel covers, in pixels. */
export interface FreePart {
  readonly left: number;
  readonly top: number;
  readonly width: number;
  readonly height: number;
}

export const free_part = ([width = 0, height = 0]: readonly number[], cover: Cover): FreePart => ({
  left: cover.left,
  top: cover.top,
  width: Math.max(0, width - cover.left - cover.right),
  height: Math.max(0, height - cover.top - cover.bottom),
});

export const clamp = (value: number, least: number, most: number): number =>
  Math.min(Math.max(value, least), most);
