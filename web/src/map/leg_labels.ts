// How long the legs are and by how much the way turns, written beside them while the mission is
// edited: where there is room, and always at what is chosen or dragged.

import { metres } from '../model/format';
import { turn_at } from '../model/legs';
import { leg, type Band } from './band';
import { stand_at, type Paint } from './canvas';
import { palette } from './palette';
import { from_plane, units_per_m, type PlanePoint } from './projection';

/** Shorter legs, on the screen, have no length beside them. */
const LENGTH_FROM_PX = 84;
const NEAR_FROM_PX = 40;
const TURN_FROM_PX = 70;
/** With more in sight only what is chosen has its figures. */
const LABELS_MOST = 40;
const BESIDE_PX = 20;
/** A way that bends less is straight to the eye. */
const STRAIGHT_DEG = 0.5;

export interface Label {
  readonly x: number;
  readonly y: number;
  readonly text: string;
  readonly strong: boolean;
}

const on_screen = ({ width_px, height_px }: Paint, x: number, y: number): boolean =>
  x > -40 && y > -20 && x < width_px + 40 && y < height_px + 20;

const pixel = (paint: Paint, [x, y]: PlanePoint): PlanePoint => [paint.x_px(x), paint.y_px(y)];

/** Beside its middle, on the side that is up, or the left one. */
const length_label = (
  paint: Paint,
  [a, b]: readonly [PlanePoint, PlanePoint],
  scale: { readonly east: number; readonly north: number },
  strong: boolean,
): Label | null => {
  const [[x0, y0], [x1, y1]] = [pixel(paint, a), pixel(paint, b)];
  const size = Math.hypot(x1 - x0, y1 - y0);
  if (size < (strong ? NEAR_FROM_PX : LENGTH_FROM_PX)) return null;
  const [nx, ny] = [(y1 - y0) / size, -(x1 - x0) / size];
  const side = ny > 0.05 || (Math.abs(ny) <= 0.05 && nx > 0) ? -1 : 1;
  const x = (x0 + x1) / 2 + side * nx * (BESIDE_PX + Math.abs(nx) * 16);
  const y = (y0 + y1) / 2 + side * ny * BESIDE_PX;
  if (!on_screen(paint, x, y)) return null;
  const length_m = Math.hypot((b[0] - a[0]) / scale.east, (b[1] - a[1]) / scale.north);
  return { x, y, text: metres(length_m), strong };
};

/** Outside of the corner. */
const turn_label = (
  paint: Paint,
  before: readonly [PlanePoint, PlanePoint],
  after: readonly [PlanePoint, PlanePoint],
  strong: boolean,
): Label | null => {
  const turn_deg = turn_at(before, after);
  if (turn_deg === null || Math.abs(turn_deg) < STRAIGHT_DEG) return null;
  const [a, at] = [pixel(paint, before[0]), pixel(paint, before[1])];
  const b = pixel(paint, after[1]);
  const [sa, sb] = [Math.hypot(at[0] - a[0], at[1] - a[1]), Math.hypot(b[0] - at[0], b[1] - at[1])];
  if (Math.min(sa, sb) < (strong ? NEAR_FROM_PX : TURN_FROM_PX)) return null;
  const [ox, oy] = [
    (at[0] - a[0]) / sa - (b[0] - at[0]) / sb,
    (at[1] - a[1]) / sa - (b[1] - at[1]) / sb,
  ];
  const size = Math.hypot(ox, oy) || 1;
  const [x, y] = [at[0] + (ox / size) * 42, at[1] + (oy / size) * 34];
  if (!on_screen(paint, x, y)) return null;
  const text = `${turn_deg > 0 ? '↱' : '↰'} ${Math.abs(turn_deg).toFixed(0)}°`;
  return { x, y, text, strong };
};

/** @param near spots whose figures are wanted also where it is narrow */
export const leg_labels = (paint: Paint, band: Band, near: ReadonlySet<number>): Label[] => {
  const scale = units_per_m(from_plane(paint.center).lat);
  const labels: Label[] = [];
  const take = (label: Label | null): void => {
    if (label) labels.push(label);
  };
  for (let k = 1; k < band.begin.length; k += 1) {
    const here = leg(band, k);
    const px = Math.max(Math.abs(here[1][0] - here[0][0]), Math.abs(here[1][1] - here[0][1]));
    if (px < NEAR_FROM_PX * 0.7 * paint.resolution) continue;
    take(length_label(paint, here, scale, near.has(k) || near.has(k - 1)));
    const circled = band.begin[k] !== band.end[k];
    if (k + 1 < band.begin.length && !circled) {
      take(turn_label(paint, here, leg(band, k + 1), near.has(k)));
    }
  }
  return labels.length > LABELS_MOST ? labels.filter(({ strong }) => strong) : labels;
};

export const paint_labels = (paint: Paint, labels: readonly Label[]): void => {
  const { context } = paint;
  const colors = palette();
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.lineJoin = 'round';
  context.lineWidth = 4;
  context.strokeStyle = colors.casing;
  for (const { x, y, text, strong } of labels.slice(0, 4 * LABELS_MOST)) {
    context.font = `${strong ? 700 : 600} ${strong ? 15 : 13}px system-ui, sans-serif`;
    context.save();
    stand_at(paint, x, y);
    context.strokeText(text, 0, 0);
    context.fillStyle = strong ? colors.selected : colors.plan;
    context.fillText(text, 0, 0);
    context.restore();
  }
};
