// The map's own drawing above the tiles, on canvases that lie on each other:
//
//   ground   what moves and lies under everything (how sure the robot is of place and heading, what it
//            sees)
//   still    what stays where it is: grid, fence, route, way so far; and on a canvas of its own, for it
//            changes alone, the mission that is edited. Drawn once with a margin around the screen, then
//            only moved; drawn again when something of it changes, or when it no longer covers the screen
//   target   where the mission is driven to: it changes with every item, and lies far from the robot
//   moving   the robot, the last metres it drove, a point that is dragged
//   above    what stands at the border of the screen
//
// Where heading is up all but the last lie on a paper that is turned as one: no painter knows of it but
// those that write. Painters draw in pixels of the paper. A mission of 10,000 items is one pass over two arrays: no feature
// objects, nothing to keep in step. What moves is drawn ten times a second on a canvas just as large as
// it needs: a canvas costs by its pixels.

import Layer from 'ol/layer/Layer';
import type { FrameState } from 'ol/Map';

import { angle_between, turned } from '../model/map_up';
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

const view_of = (frame: FrameState): View => {
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

const run = (painters: readonly Painter[], paint: Paint): void => {
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

/** Pixels around the screen that are drawn as well: how far one may go until all is drawn again. */
const margin_of = ({ width_px, height_px }: View): number =>
  Math.round(Math.min(192, 0.3 * Math.min(width_px, height_px)));
/** Shown larger or smaller than this it is drawn again in the middle of a zoom, too. */
const SCALED = 1.9;
/** By so much the words on it may lean: it need not be drawn again with every degree that the robot turns. */
const WORDS_TILT_RAD = 0.1;

/** What stays where it is. */
export class Still {
  readonly sheet = new Sheet(true);
  #drawn: View | null = null;

  /** @return whether it must be drawn again */
  move(view: View): boolean {
    const drawn = this.#drawn;
    if (!drawn || drawn.width_px !== view.width_px || drawn.height_px !== view.height_px)
      return true;
    if (drawn.ratio !== view.ratio) return true;
    if (Math.abs(angle_between(drawn.turn_rad, view.turn_rad)) > WORDS_TILT_RAD) return true;
    const scale = view.fit.a / drawn.fit.a;
    const same = Math.abs(scale - 1) < 1e-9;
    if (!same && (!view.in_motion || scale > SCALED || scale < 1 / SCALED)) return true;
    const margin = margin_of(view);
    const x = view.fit.e - scale * (drawn.fit.e + margin);
    const y = view.fit.f - scale * (drawn.fit.f + margin);
    const right = x + scale * (view.width_px + 2 * margin);
    const bottom = y + scale * (view.height_px + 2 * margin);
    const covers = x <= 0 && y <= 0 && right >= view.width_px && bottom >= view.height_px;
    // Zoomed out, the margins may be short for a moment; standing still, never.
    if (!covers && same) return true;
    this.#show(scale, x, y, view.ratio);
    return false;
  }

  draw(view: View, painters: readonly Painter[]): void {
    const margin = margin_of(view);
    const [width, height] = [view.width_px + 2 * margin, view.height_px + 2 * margin];
    const context = this.sheet.begin(width, height, view.ratio);
    if (!context) return;
    run(painters, { context, ...pixels_of(view, margin) });
    this.sheet.end();
    this.#drawn = view;
    this.#show(1, -margin, -margin, view.ratio);
  }

  /** Whole pixels: between them lines would blur. */
  #show(scale: number, x: number, y: number, ratio: number): void {
    const whole = (value: number): number => Math.round(value * ratio) / ratio;
    this.sheet.place(
      Math.abs(scale - 1) < 1e-9
        ? `translate(${whole(x)}px, ${whole(y)}px)`
        : `translate(${x}px, ${y}px) scale(${scale})`,
    );
  }
}

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
    const paint = { context, ...pixels_of(view, 0) };
    run(
      movers.filter((mover) => mover.box !== null).map((mover) => mover.paint),
      paint,
    );
  }
}

/** What stays, on one canvas. */
export interface Stays {
  readonly painters: readonly Painter[];
  /** Whether something of it has changed since it was asked last. */
  changed(): boolean;
}

/** What is drawn, and when. */
export interface Drawing {
  /** From below. */
  readonly still: readonly Stays[];
  ground(view: View): readonly Mover[];
  target(view: View): readonly Mover[];
  moving(view: View): readonly Mover[];
  /** Places of the screen, whichever way the map is turned. */
  above(view: View): readonly Mover[];
  /** Beside it, what does not move with the map. @param again what stays was drawn again */
  beside(view: View, again: boolean): readonly HTMLElement[];
}

const laid_over = (style: Partial<CSSStyleDeclaration>): HTMLDivElement => {
  const box = document.createElement('div');
  Object.assign(box.style, { position: 'absolute', inset: '0', pointerEvents: 'none', ...style });
  return box;
};

/** Lays the paper around the screen's middle, turned. @param last as it lay in the frame before */
const lay = (paper: HTMLElement, view: View, last: View | null): void => {
  const { turn_rad, width_px, height_px, screen } = view;
  const same = last?.width_px === width_px && last.height_px === height_px;
  if (same && last.turn_rad === turn_rad) return;
  const aside = (paper_px: number, screen_px: number): number => (screen_px - paper_px) / 2;
  Object.assign(
    paper.style,
    turn_rad === 0
      ? { inset: '0', transform: '' }
      : {
          inset: `${aside(height_px, screen.height_px)}px ${aside(width_px, screen.width_px)}px`,
          transform: `rotate(${turn_rad}rad)`,
        },
  );
};

/** The screen itself as what is painted on. */
const upright_view = (view: View): View =>
  view.turn_rad === 0 ? view : { ...view, ...view.screen, turn_rad: 0 };

export const canvas_layer = (drawing: Drawing): Layer => {
  // Words that a drag has marked are dragged themselves by the next one, and the map stands still.
  const box = laid_over({ overflow: 'hidden', userSelect: 'none', webkitUserSelect: 'none' });
  const paper = laid_over({});
  const [ground, target] = [new Moving(), new Moving()];
  const stills = drawing.still.map((stays) => ({ stays, still: new Still() }));
  const [moving, above] = [new Moving(), new Moving()];
  const sheets = [ground, ...stills.map(({ still }) => still), target, moving];
  paper.append(...sheets.map(({ sheet }) => sheet.canvas));
  box.append(paper, above.sheet.canvas);
  let last: View | null = null;
  return new Layer({
    render: (frame) => {
      const view = view_of(frame);
      lay(paper, view, last);
      last = view;
      let again = false;
      for (const { stays, still } of stills) {
        const changed = stays.changed();
        if (!still.move(view) && !changed) continue;
        still.draw(view, stays.painters);
        again = true;
      }
      ground.draw(view, drawing.ground(view));
      target.draw(view, drawing.target(view));
      moving.draw(view, drawing.moving(view));
      above.draw(upright_view(view), drawing.above(view));
      for (const element of drawing.beside(view, again)) {
        if (element.parentNode !== box) box.append(element);
      }
      return box;
    },
  });
};

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
  const { width_px, height_px } = paint;
  const [left, top] = [-BEYOND_PX, -BEYOND_PX];
  const frame = { left, top, right: width_px + BEYOND_PX, bottom: height_px + BEYOND_PX };
  draw_thinned(paint.context, points, frame, first, end);
};
