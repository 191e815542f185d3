// Under a finger nothing is seen: beside it the map is shown larger while a point is dragged.

import type { PlanePoint } from './projection';

const SIZE_PX = 132;
const TIMES = 2;
/** From the finger's place to the edge of the glass. */
const APART_PX = 46;

export class Loupe {
  readonly #map: HTMLElement;
  readonly #glass = document.createElement('canvas');
  #at: PlanePoint | null = null;

  /** @param map the element with the map's canvases */
  constructor(map: HTMLElement) {
    this.#map = map;
    const ratio = Math.min(window.devicePixelRatio, 2);
    this.#glass.width = SIZE_PX * ratio;
    this.#glass.height = SIZE_PX * ratio;
    this.#glass.className = 'map-loupe';
    this.#glass.setAttribute('aria-hidden', 'true');
    Object.assign(this.#glass.style, {
      position: 'absolute',
      zIndex: '1',
      width: `${SIZE_PX}px`,
      height: `${SIZE_PX}px`,
      border: '3px solid var(--accent)',
      borderRadius: '50%',
      boxShadow: 'var(--shadow)',
      pointerEvents: 'none',
    });
    this.#glass.hidden = true;
    map.append(this.#glass);
  }

  /** @param at pixels of the map; null: nothing is dragged */
  point(at: PlanePoint | null): void {
    this.#at = at;
    this.#glass.hidden = at === null;
    if (!at) return;
    const [x, y] = at;
    // Above the finger, or where that is no longer seen, beside it.
    const above = y - APART_PX - SIZE_PX;
    const left = above > 8 ? x - SIZE_PX / 2 : x - APART_PX - SIZE_PX;
    const room = this.#map.clientWidth - SIZE_PX - 4;
    const beside = left < 4 && above <= 8 ? x + APART_PX : left;
    this.#glass.style.left = `${Math.max(4, Math.min(room, beside))}px`;
    this.#glass.style.top = `${Math.max(8, above)}px`;
  }

  /** After the map was drawn. */
  draw(): void {
    const context = this.#glass.getContext('2d');
    if (!this.#at || !context) return;
    const [x, y] = this.#at;
    const { width, height } = this.#glass;
    context.fillStyle = getComputedStyle(this.#map).backgroundColor;
    context.fillRect(0, 0, width, height);
    for (const canvas of this.#map.querySelectorAll<HTMLCanvasElement>('canvas')) {
      if (canvas === this.#glass || canvas.clientWidth === 0) continue;
      const box = canvas.getBoundingClientRect();
      const map = this.#map.getBoundingClientRect();
      const scale = canvas.width / box.width;
      const side = (SIZE_PX / TIMES) * scale;
      const [left, top] = [x - (box.left - map.left), y - (box.top - map.top)];
      context.drawImage(
        canvas,
        ...([left * scale - side / 2, top * scale - side / 2, side, side] as const),
        ...([0, 0, width, height] as const),
      );
    }
    this.#cross(context, width / 2);
  }

  #cross(context: CanvasRenderingContext2D, middle: number): void {
    const arm = middle / 6;
    context.beginPath();
    context.moveTo(middle - arm, middle);
    context.lineTo(middle + arm, middle);
    context.moveTo(middle, middle - arm);
    context.lineTo(middle, middle + arm);
    context.lineWidth = 2;
    context.strokeStyle = 'rgba(0, 0, 0, 0.9)';
    context.stroke();
  }
}
