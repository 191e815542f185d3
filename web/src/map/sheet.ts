// A canvas and its place on the screen.

/** Lies at the paper's corner, moved by its transform alone. */
export const laid = <T extends HTMLElement>(element: T): T => {
  Object.assign(element.style, {
    position: 'absolute',
    left: '0',
    top: '0',
    transformOrigin: '0 0',
    willChange: 'transform',
    pointerEvents: 'none',
  });
  return element;
};

/** A canvas that is drawn on often, and its size on the screen. */
export class Sheet {
  readonly canvas = laid(document.createElement('canvas'));
  readonly #context = this.canvas.getContext('2d');
  #width_px = 0;
  #height_px = 0;
  #seen = true;
  #transform = '';

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
    if (canvas.width !== width || canvas.height !== height) {
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
}
