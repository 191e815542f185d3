// Where a picture is drawn that then stays for long, and what shows it.
//
// Without a graphics card the browser copies a canvas that can still be drawn on with every frame, whether
// it was or not; a finished picture it does not.

import { laid } from './sheet';

export class Easel {
  readonly #paper: OffscreenCanvas;
  readonly #context: CanvasRenderingContext2D;

  private constructor(paper: OffscreenCanvas, context: OffscreenCanvasRenderingContext2D) {
    this.#paper = paper;
    // Of the other one it lacks only what belongs to the document, and no painter uses that.
    this.#context = context as unknown as CanvasRenderingContext2D;
  }

  /** @return null: the browser does not know it; canvases are drawn on themselves then */
  static set_up(): Easel | null {
    if (typeof OffscreenCanvas === 'undefined' || !('ImageBitmapRenderingContext' in window)) {
      return null;
    }
    const paper = new OffscreenCanvas(1, 1);
    const context = paper.getContext('2d');
    // Some browsers have the one and not yet the other.
    return context && 'reset' in context ? new Easel(paper, context) : null;
  }

  /** @param width and @param height in the device's own pixels */
  begin(width: number, height: number): CanvasRenderingContext2D {
    // Either makes it anew, and what was finished last was taken off with its paper.
    if (this.#paper.width !== width) this.#paper.width = width;
    if (this.#paper.height !== height) this.#paper.height = height;
    this.#context.reset();
    return this.#context;
  }

  finish(): ImageBitmap {
    return this.#paper.transferToImageBitmap();
  }
}

/** A finished picture on the screen. */
export class Frame {
  readonly canvas = laid(document.createElement('canvas'));

  show(picture: ImageBitmap, ratio: number): void {
    this.#size(picture.width / ratio, picture.height / ratio);
    this.canvas.getContext('bitmaprenderer')?.transferFromImageBitmap(picture);
  }

  /** Where there is no easel. */
  begin(width: number, height: number, ratio: number): CanvasRenderingContext2D | null {
    this.#size(width / ratio, height / ratio);
    Object.assign(this.canvas, { width, height }); // clears it
    return this.canvas.getContext('2d');
  }

  place(left_px: number, top_px: number): void {
    Object.assign(this.canvas.style, { left: `${left_px}px`, top: `${top_px}px` });
  }

  #size(width_px: number, height_px: number): void {
    this.canvas.style.width = `${width_px}px`;
    this.canvas.style.height = `${height_px}px`;
  }
}
