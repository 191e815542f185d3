// Draws a circle around a place, with arrows that tell which way round.

import { stroke_cased, type Paint } from './canvas';

export interface RingLook {
  /** Null: no way, but an area. */
  readonly clockwise: boolean | null;
  /** Width of its line; null: faint, dashed. */
  readonly line_px: number | null;
  readonly color: string;
  readonly casing: string;
}

/** With a smaller one there is no room for arrows. */
const ARROWS_FROM_PX = 15;
const ARROW_PX = 11;
const ARROWS_AT_RAD = [0.5, 2.6, 4.7];

/** @param x, y, r on the screen */
export const paint_ring_line = (
  { context }: Paint,
  x: number,
  y: number,
  r: number,
  { line_px, color, casing }: RingLook,
): void => {
  context.beginPath();
  context.arc(x, y, r, 0, 2 * Math.PI);
  context.setLineDash(line_px === null ? [4, 5] : []);
  stroke_cased(context, casing, color, line_px ?? 1.5);
  context.setLineDash([]);
};

/** Which way round. */
export const paint_ring_arrows = (
  { context }: Paint,
  x: number,
  y: number,
  r: number,
  { clockwise, color, casing }: RingLook,
): void => {
  if (clockwise === null || r < ARROWS_FROM_PX) return;
  context.beginPath();
  for (const at of ARROWS_AT_RAD) {
    // On the screen angles grow clockwise.
    const heading = at + (clockwise ? Math.PI / 2 : -Math.PI / 2);
    const tip_x = x + r * Math.cos(at);
    const tip_y = y + r * Math.sin(at);
    for (const side of [2.5, -2.5]) {
      context.moveTo(tip_x, tip_y);
      context.lineTo(
        tip_x + ARROW_PX * Math.cos(heading + side),
        tip_y + ARROW_PX * Math.sin(heading + side),
      );
    }
  }
  stroke_cased(context, casing, color, 3);
};
