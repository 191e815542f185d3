// What of the plane is in sight, and which part of the window is free for it.

import type View from 'ol/View';

import { turned } from '../model/map_up';
import type { LatLon } from '../model/plan';
import type { Cover } from './grid';
import { to_plane } from './projection';

export const FIT_MARGIN_PX = 48;
/** The map's buttons stand there. */
const FIT_RIGHT_PX = 88;

const extent_of = (points: readonly LatLon[]): [number, number, number, number] => {
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

/** Where it will be drawn; the map itself knows only where it was in the last frame. */
export const pixel_of = (
  view: View,
  at: LatLon,
  free: FreePart,
): readonly [x: number, y: number] => {
  const [x, y] = to_plane(at);
  const [center_x = 0, center_y = 0] = view.getCenter() ?? [];
  const resolution = view.getResolution() ?? 1;
  const [right, down] = turned(
    [(x - center_x) / resolution, (center_y - y) / resolution],
    view.getRotation(),
  );
  return [free.left + free.width / 2 + right, free.top + free.height / 2 + down];
};

export const in_part = (
  [x, y]: readonly [x: number, y: number],
  { left, top, width, height }: FreePart,
  margin: number,
): boolean =>
  x > left + margin && x < left + width - margin && y > top + margin && y < top + height - margin;

/** Moves what is seen to the right and down, pixels. */
export const push_view = (view: View, right_px: number, down_px: number): void => {
  const [right, down] = turned([right_px, down_px], -view.getRotation());
  const [center_x = 0, center_y = 0] = view.getCenter() ?? [];
  const resolution = view.getResolution() ?? 1;
  view.setCenter([center_x - right * resolution, center_y + down * resolution]);
};

export type Padding = readonly [top: number, right: number, bottom: number, left: number];

/** What was fitted, to be fitted anew. */
export interface Fitted {
  readonly fit: (padding: Padding) => void;
  /** Where its places are now. */
  readonly pixels: () => (readonly [x: number, y: number])[];
  readonly padding: Padding;
}

/** All of them are seen, none of them beneath the buttons; in the middle where there is room for that. */
export const fit_in = (
  view: View,
  points: readonly LatLon[],
  free: FreePart,
  max_zoom: number,
): Fitted => {
  const padding = [FIT_MARGIN_PX, FIT_RIGHT_PX, FIT_MARGIN_PX, FIT_MARGIN_PX] as const;
  const fit: Fitted['fit'] = (by) =>
    view.fit(extent_of(points), { padding: [...by], maxZoom: max_zoom });
  const pixels: Fitted['pixels'] = () => points.map((at) => pixel_of(view, at, free));
  fit(padding);
  const rightmost = Math.max(...pixels().map(([x]) => x));
  const room = free.left + free.width - FIT_RIGHT_PX - rightmost;
  push_view(view, clamp(room, 0, (FIT_RIGHT_PX - FIT_MARGIN_PX) / 2), 0);
  return { fit, pixels, padding };
};

/**
 * Fits at once, and beside what stands over the map when the code for that has come. Over a weak link
 * that takes seconds: not if the map was moved since, or something else fitted. Without a link the
 * places stay where they are.
 */
export const make_fit = (view: View, load = () => import('./fit_beside')) => {
  const seen = () => `${view.getCenter()} ${view.getResolution()}`;
  let last: Fitted;
  return (
    points: readonly LatLon[],
    free: FreePart,
    max_zoom: number,
    target: HTMLElement,
  ): Promise<void> => {
    const fitted = (last = fit_in(view, points, free, max_zoom));
    const before = seen();
    return load().then(
      (it) => {
        if (fitted === last && seen() === before) it.keep_clear(view, fitted, free, target);
      },
      () => undefined,
    );
  };
};

export const clamp = (value: number, least: number, most: number): number =>
  Math.min(Math.max(value, least), most);
