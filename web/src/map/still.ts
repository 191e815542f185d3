// What stays where it is: drawn once with a margin around the screen, then only moved; drawn again when
// something of it changes, or when it no longer covers the screen.
//
// A mission of thousands of items on a large screen takes longer than a frame has, so it is drawn in
// pieces, one with each frame, and what was drawn before is seen until all of them are there:
//
//   changed, or it does not cover ─▶ begin ─▶ a piece ─▶ a piece ─▶ … ─▶ shown
//                                      ▲                │
//                                      └── the view is far from that of the first piece

import { angle_between } from '../model/map_up';
import { pieces_of, type Piece } from '../model/pieces';
import { pixels_of, run, type Painter, type View } from './canvas';
import { Easel, Frame } from './easel';
import { laid } from './sheet';

/** What stays, on one sheet. */
export interface Stays {
  readonly painters: readonly Painter[];
  /** Whether something of it has changed since it was asked last. */
  changed(): boolean;
  /** It is going to be drawn as it is now, over the next frames. */
  begin(): void;
  /** As it was at the begin it is on the screen. */
  shown(): void;
}

/** Pixels around the screen that are drawn as well: how far one may go until all is drawn again. */
const margin_of = ({ width_px, height_px }: View): number =>
  Math.round(Math.min(192, 0.3 * Math.min(width_px, height_px)));
/** Shown larger or smaller than this it is drawn again in the middle of a zoom, too. */
const SCALED = 1.9;
/** By so much the words on it may lean: it need not be drawn again with every degree that the robot turns. */
const WORDS_TILT_RAD = 0.1;

/** How what was drawn lies under another view. */
interface Lie {
  readonly scale: number;
  readonly x: number;
  readonly y: number;
}
/** @return null: it does not fit, and must be drawn again */
const lie_of = (drawn: View, view: View): Lie | null => {
  if (drawn.width_px !== view.width_px || drawn.height_px !== view.height_px) return null;
  if (drawn.ratio !== view.ratio) return null;
  if (Math.abs(angle_between(drawn.turn_rad, view.turn_rad)) > WORDS_TILT_RAD) return null;
  const scale = view.fit.a / drawn.fit.a;
  const same = Math.abs(scale - 1) < 1e-9;
  if (!same && (!view.in_motion || scale > SCALED || scale < 1 / SCALED)) return null;
  const lie = laid_under(drawn, view);
  const margin = margin_of(view);
  const right = lie.x + scale * (view.width_px + 2 * margin);
  const bottom = lie.y + scale * (view.height_px + 2 * margin);
  const covers = lie.x <= 0 && lie.y <= 0 && right >= view.width_px && bottom >= view.height_px;
  // Zoomed out, the margins may be short for a moment; standing still, never.
  return !covers && same ? null : lie;
};

const laid_under = (drawn: View, view: View): Lie => {
  const scale = view.fit.a / drawn.fit.a;
  const margin = margin_of(drawn);
  return {
    scale,
    x: view.fit.e - scale * (drawn.fit.e + margin),
    y: view.fit.f - scale * (drawn.fit.f + margin),
  };
};

/** In the middle of being drawn. */
interface Begun {
  readonly view: View;
  readonly pieces: readonly Piece[];
  readonly pictures: ImageBitmap[];
}

export class Still {
  /** Holds its frames, and is moved. */
  readonly box = laid(document.createElement('div'));
  readonly #stays: Stays;
  readonly #easel = Easel.set_up();
  #frames: readonly Frame[] = [];
  #transform = '';
  #drawn: View | null = null;
  #begun: Begun | null = null;
  /** What had changed when it was begun was not shown. */
  #dropped = false;

  constructor(stays: Stays) {
    this.#stays = stays;
  }

  /** There are pieces left to draw. */
  get begun(): boolean {
    return this.#begun !== null;
  }

  /**
   * Goes on by what is left of this frame's pieces, and lies where the view wants it.
   * @return whether it was drawn again, and is shown
   */
  step(view: View, budget: { pieces: number }): boolean {
    if (this.#begun && !lie_of(this.#begun.view, view)) this.#drop();
    if (!this.#begun) {
      const changed = this.#stays.changed() || this.#dropped;
      if (changed || !this.#drawn || !lie_of(this.#drawn, view)) this.#begin(view);
    }
    const again = this.#begun !== null && this.#go_on(this.#begun, budget);
    if (this.#drawn) this.#lie(laid_under(this.#drawn, view), view.ratio);
    return again;
  }

  #begin(view: View): void {
    this.#dropped = false;
    this.#stays.begin();
    const margin = margin_of(view);
    const pieces = pieces_of(view.width_px + 2 * margin, view.height_px + 2 * margin, view.ratio);
    this.#begun = { view, pieces, pictures: [] };
  }

  #drop(): void {
    for (const picture of this.#begun?.pictures ?? []) picture.close();
    this.#begun = null;
    this.#dropped = true;
  }

  /** @return all of it is there */
  #go_on(begun: Begun, budget: { pieces: number }): boolean {
    if (!this.#easel) return this.#draw_at_once(begun);
    for (const piece of begun.pieces.slice(begun.pictures.length)) {
      if (budget.pieces === 0) return false;
      budget.pieces -= 1;
      this.#paint(begun.view, piece, this.#easel.begin(piece.width, piece.height));
      begun.pictures.push(this.#easel.finish());
    }
    this.#hang(begun);
    begun.pictures.forEach((picture, k) => this.#frames[k]?.show(picture, begun.view.ratio));
    return true;
  }

  #draw_at_once(begun: Begun): boolean {
    this.#hang(begun);
    begun.pieces.forEach((piece, k) => {
      const { ratio } = begun.view;
      const context = this.#frames[k]?.begin(piece.width, piece.height, ratio) ?? null;
      if (context) this.#paint(begun.view, piece, context);
    });
    return true;
  }

  #paint(view: View, piece: Piece, context: CanvasRenderingContext2D): void {
    const { left, top } = piece;
    context.setTransform(view.ratio, 0, 0, view.ratio, -left * view.ratio, -top * view.ratio);
    run(this.#stays.painters, { context, piece, ...pixels_of(view, margin_of(view)) });
  }

  /** As many frames as there are pieces. */
  #hang({ view, pieces }: Begun): void {
    if (this.#frames.length !== pieces.length) {
      this.#frames = pieces.map(() => new Frame());
      this.box.replaceChildren(...this.#frames.map(({ canvas }) => canvas));
    }
    this.#frames.forEach((frame, k) => {
      const { left = 0, top = 0 } = pieces[k] ?? {};
      frame.place(left, top);
    });
    this.#drawn = view;
    this.#begun = null;
    this.#stays.shown();
  }

  /** Whole pixels: between them lines would blur. All frames as one: they keep their places in the box. */
  #lie({ scale, x, y }: Lie, ratio: number): void {
    const whole = (value: number): number => Math.round(value * ratio) / ratio;
    const transform =
      Math.abs(scale - 1) < 1e-9
        ? `translate(${whole(x)}px, ${whole(y)}px)`
        : `translate(${x}px, ${y}px) scale(${scale})`;
    if (transform === this.#transform) return;
    this.#transform = transform;
    this.box.style.transform = transform;
  }
}
