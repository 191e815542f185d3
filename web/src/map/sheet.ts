// A canvas and its place on the screen; what is drawn once is handed over as a finished picture.

/**
 * What is drawn once is handed to the screen as a finished picture: without a graphics card the browser
 * copies a canvas that can still be drawn on with every frame, whether it was or not.
 */
class Picture {
  readonly #screen: ImageBitmapRenderingContext;
  readonly #paper: OffscreenCanvas;
  readonly context: CanvasRenderingContext2D;

  private constructor(
    screen: ImageBitmapRenderingContext,
    paper: OffscreenCanvas,
    context: OffscreenCanvasRenderingContext2D,
  ) {
    this.#screen = screen;
    this.#paper = paper;
    // Of the other one it lacks only what belongs to the document, and no painter uses that.
    this.context = context as unknown as CanvasRenderingContext2D;
  }

  /** @return null: the browser does not know it; it draws on the canvas itself then */
  static of(canvas: HTMLCanvasElement): Picture | null {
    if (typeof OffscreenCanvas === 'undefined') return null;
    const paper = new OffscreenCanvas(1, 1);
    const context = paper.getContext('2d');
    const screen = context && canvas.getContext('bitmaprenderer');
    return screen && new Picture(screen, paper, context);
  }

  size(width: number, height: number): void {
    this.#paper.width = width;
    this.#paper.height = height;
  }

  hand_over(): void {
    this.#screen.transferFromImageBitmap(this.#paper.transferToImageBitmap());
  }
}

/** A canvas, and its size on the screen. */
export class Sheet {
  readonly canvas = document.createElement('canvas');
  readonly #picture: Picture | null;
  readonly #context: CanvasRenderingContext2D | null;
  #width_px = 0;
  #height_px = 0;
  #seen = true;
  #transform = '';

  /** @param finished what is drawn on it stays for long */
  constructor(finished = false) {
    this.#picture = finished ? Picture.of(this.canvas) : null;
    this.#context = this.#picture?.context ?? this.canvas.getContext('2d');
    Object.assign(this.canvas.style, {
      position: 'absolute',
      left: '0',
      top: '0',
      transformOrigin: '0 0',
      willChange: 'transform',
      pointerEvents: 'none',
    });
  }

  place(transform: string): void {
    if (transform === this.#transform) return;
    this.#transform = transform;
    this.canvas.style.transform = transform;
  }

  show(seen: boolean): void {
    if (seen === this.#seen) return;
    this.#seen = seen;
    this.canvas.style.display = seen ? '' : 'none';
  }

  /** Clears it. @return null: the browser gives no canvas */
  begin(width_px: number, height_px: number, ratio: number): CanvasRenderingContext2D | null {
    const { canvas } = this;
    const [width, height] = [Math.ceil(width_px * ratio), Math.ceil(height_px * ratio)];
    if (this.#picture) this.#picture.size(width, height);
    else if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    if (this.#width_px !== width_px || this.#height_px !== height_px) {
      canvas.style.width = `${width_px}px`;
      canvas.style.height = `${height_px}px`;
      [this.#width_px, this.#height_px] = [width_px, height_px];
    }
    this.#context?.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.#context?.clearRect(0, 0, width_px, height_px);
    return this.#context;
  }

  /** All is drawn. */
  end(): void {
    this.#picture?.hand_over();
  }
}
