// One canvas above the tiles on which painters draw in order, every frame, in screen pixels. A
// mission of 10,000 items is one pass over two arrays: no feature objects, nothing to keep in step.

import Layer from 'ol/layer/Layer';
import type { FrameState } from 'ol/Map';

import type { PlanePoint } from './projection';

/** What a painter gets: a context in CSS pixels and the way from the plane to the screen. */
export interface Paint {
  readonly context: CanvasRenderingContext2D;
  readonly width_px: number;
  readonly height_px: number;
  /** Plane units of one pixel. */
  readonly resolution: number;
  readonly center: PlanePoint;
  x_px(x: number): number;
  y_px(y: number): number;
}
export type Painter = (paint: Paint) => void;

const sized = (canvas: HTMLCanvasElement, width_px: number, height_px: number, ratio: number) => {
  const width = Math.round(width_px * ratio);
  const height = Math.round(height_px * ratio);
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
    canvas.style.width = `${width_px}px`;
    canvas.style.height = `${height_px}px`;
  }
};

const paint_of = (context: CanvasRenderingContext2D, frame: FrameState): Paint => {
  const [width_px = 0, height_px = 0] = frame.size;
  // The map never turns, so the transform has no mixed terms: [a, 0, 0, d, e, f].
  const [a = 1, , , d = 1, e = 0, f = 0] = frame.coordinateToPixelTransform;
  const [x = 0, y = 0] = frame.viewState.center;
  return {
    context,
    width_px,
    height_px,
    resolution: frame.viewState.resolution,
    center: [x, y],
    x_px: (plane_x) => a * plane_x + e,
    y_px: (plane_y) => d * plane_y + f,
  };
};

export const canvas_layer = (painters: readonly Painter[]): Layer => {
  const canvas = document.createElement('canvas');
  canvas.style.position = 'absolute';
  canvas.style.pointerEvents = 'none';
  const context = canvas.getContext('2d');
  return new Layer({
    render: (frame) => {
      if (!context) return canvas;
      const ratio = frame.pixelRatio;
      sized(canvas, frame.size[0] ?? 0, frame.size[1] ?? 0, ratio);
      context.setTransform(ratio, 0, 0, ratio, 0, 0);
      const paint = paint_of(context, frame);
      context.clearRect(0, 0, paint.width_px, paint.height_px);
      for (const painter of painters) {
        context.save();
        painter(paint);
        context.restore();
      }
      return canvas;
    },
  });
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
