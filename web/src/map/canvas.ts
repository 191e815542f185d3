// What painters get: the way from the plane to the paper's pixels, and lines as a map draws them. Painters
// draw in pixels of the paper. A mission of 10,000 items is one pass over two arrays: no feature objects,
// nothing to keep in step.

import type { FrameState } from 'ol/Map';

import { turned } from '../model/map_up';
import { draw_thinned } from '../model/thinned';
import type { PlanePoint } from './projection';
import { Sheet } from './sheet';

/**
 * The way from the plane to the paper, in CSS pixels. Where north is up the paper is the screen; else it is
 * a square around the screen's middle, on which north is up, and that is turned as a whole.
 */
export interface Pixels {
  readonly width_px: number;
  readonly height_px: number;
  /** Plane units of one pixel. */
  readonly resolution: number;
  readonly center: PlanePoint;
  /** By how much the paper is turned, clockwise. */
  readonly turn_rad: number;
  x_px(x: number): number;
  y_px(y: number): number;
}
/** What a painter gets. */
export interface Paint extends Pixels {
  readonly context: CanvasRenderingContext2D;
  /** What is drawn of the paper now; what goes where is decided for all of it. */
  readonly piece: Box;
}
export type Painter = (paint: Paint) => void;

/** A part of the paper, pixels. */
export interface Box {
  readonly left: number;
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
}

/** From the plane to the paper's pixels. */
interface Fit {
  readonly a: number;
  readonly d: number;
  readonly e: number;
  readonly f: number;
}

export interface View {
  readonly fit: Fit;
  readonly width_px: number;
  readonly height_px: number;
  readonly resolution: number;
  readonly center: PlanePoint;
  readonly turn_rad: number;
  /** What is seen of the paper. */
  readonly screen: { readonly width_px: number; readonly height_px: number };
  readonly ratio: number;
  /** It is being zoomed or pushed. */
  readonly in_motion: boolean;
}

export const view_of = (frame: FrameState): View => {
  const { resolution, rotation: turn_rad } = frame.viewState;
  const [x = 0, y = 0] = frame.viewState.center;
  const [width = 0, height = 0] = frame.size;
  const side = Math.ceil(Math.hypot(width, height));
  const [width_px, height_px] = turn_rad === 0 ? [width, height] : [side, side];
  return {
    fit: {
      a: 1 / resolution,
      d: -1 / resolution,
      e: width_px / 2 - x / resolution,
      f: height_px / 2 + y / resolution,
    },
    width_px,
    height_px,
    resolution,
    center: [x, y],
    turn_rad,
    screen: { width_px: width, height_px: height },
    ratio: frame.pixelRatio,
    in_motion: frame.viewHints.some((hint) => hint > 0),
  };
};

/** Where a place is on the screen, however the paper is turned. */
export const on_screen_px = (view: View, [x, y]: PlanePoint): readonly [x: number, y: number] => {
  const [right, down] = turned(
    [(x - view.center[0]) / view.resolution, (view.center[1] - y) / view.resolution],
    view.turn_rad,
  );
  return [view.screen.width_px / 2 + right, view.screen.height_px / 2 + down];
};

export const run = (painters: readonly Painter[], paint: Paint): void => {
  for (const painter of painters) {
    paint.context.save();
    painter(paint);
    paint.context.restore();
  }
};

/** @param margin_px around the screen */
export const pixels_of = (view: View, margin_px: number): Pixels => {
  const { a, d, e, f } = view.fit;
  return {
    width_px: view.width_px + 2 * margin_px,
    height_px: view.height_px + 2 * margin_px,
    resolution: view.resolution,
    center: view.center,
    turn_rad: view.turn_rad,
    x_px: (x) => a * x + e + margin_px,
    y_px: (y) => d * y + f + margin_px,
  };
};

/** What moves is drawn in steps of this, so that its canvas seldom changes its size. */
const STEP_PX = 128;

/** What moves, with the part of the screen that it needs. */
export interface Mover {
  /** Null: nothing of it is seen. */
  readonly box: Box | null;
  readonly paint: Painter;
}

const around = (movers: readonly Mover[], view: View): Box | null => {
  const boxes = movers.flatMap(({ box }) => box ?? []);
  const clipped = {
    left: Math.max(0, Math.floor(Math.min(...boxes.map((box) => box.left)))),
    top: Math.max(0, Math.floor(Math.min(...boxes.map((box) => box.top)))),
    right: Math.min(view.width_px, Math.max(...boxes.map((box) => box.right))),
    bottom: Math.min(view.height_px, Math.max(...boxes.map((box) => box.bottom))),
  };
  return clipped.right > clipped.left && clipped.bottom > clipped.top ? clipped : null;
};

export class Moving {
  readonly sheet = new Sheet();

  draw(view: View, movers: readonly Mover[]): void {
    const box = around(movers, view);
    this.sheet.show(box !== null);
    if (!box) return;
    const stepped = (length: number, most: number): number =>
      Math.min(Math.ceil(length / STEP_PX) * STEP_PX, Math.ceil(most));
    const width_px = stepped(box.right - box.left, view.width_px);
    const height_px = stepped(box.bottom - box.top, view.height_px);
    const context = this.sheet.begin(width_px, height_px, view.ratio);
    if (!context) return;
    context.translate(-box.left, -box.top);
    this.sheet.place(`translate(${box.left}px, ${box.top}px)`);
    const paint = { context, piece: box, ...pixels_of(view, 0) };
    run(
      movers.filter((mover) => mover.box !== null).map((mover) => mover.paint),
      paint,
    );
  }
}

/** The origin goes to a place, and up is up on the screen: words are read, whichever way the map is turned. */
export const stand_at = ({ context, turn_rad }: Paint, x: number, y: number): void => {
  context.translate(x, y);
  if (turn_rad !== 0) context.rotate(-turn_rad);
};

/** Strokes twice: a wide casing in the ground's colour, then the line itself. */
export const stroke_cased = (
  context: CanvasRenderingContext2D,
  casing: string,
  color: string,
  width_px: number,
): void => {
  context.lineJoin = 'round';
  context.lineCap = 'round';
  context.strokeStyle = casing;
  context.lineWidth = width_px + 3;
  context.stroke();
  context.strokeStyle = color;
  context.lineWidth = width_px;
  context.stroke();
};

/** Half of the widest line, and more. */
const BEYOND_PX = 24;

/** Adds a line to the path; points within 1.5 px of the last one are passed over. */
export const trace = (
  { context, x_px, y_px }: Paint,
  xs: ArrayLike<number>,
  ys: ArrayLike<number>,
  first = 0,
  end = xs.length,
): void => {
  let last_x = Number.NaN;
  let last_y = Number.NaN;
  for (let k = first; k < end; k += 1) {
    const x = x_px(xs[k] ?? 0);
    const y = y_px(ys[k] ?? 0);
    if (k === first) context.moveTo(x, y);
    else if (k < end - 1 && Math.abs(x - last_x) < 1.5 && Math.abs(y - last_y) < 1.5) continue;
    else context.lineTo(x, y);
    last_x = x;
    last_y = y;
  }
};

/** Adds a line that is only stroked, without what no pixel shows. @param first, end as above */
export const trace_open = (
  paint: Paint,
  xs: ArrayLike<number>,
  ys: ArrayLike<number>,
  first = 0,
  end = xs.length,
): void => {
  const points = {
    x_px: (k: number) => paint.x_px(xs[k] ?? 0),
    y_px: (k: number) => paint.y_px(ys[k] ?? 0),
  };
  const { left, top, right, bottom } = paint.piece;
  const frame = {
    left: left - BEYOND_PX,
    top: top - BEYOND_PX,
    right: right + BEYOND_PX,
    bottom: bottom + BEYOND_PX,
  };
  draw_thinned(paint.context, points, frame, first, end);
};
