// The words beside the grid's lines: along the upper and the left edge of what no panel covers. They
// move with the map along their edge, and are written anew only when the grid is.

import type { LatLon } from '../model/plan';
import type { View } from './canvas';
import { labels_of, type Cover, type GridLabel } from './grid';
import type { Palette } from './palette';

/** Written beyond the edges, too, so that they come into sight. */
const BEYOND_PX = 200;
/** Where a word leaves the map it fades: cut through it reads as another figure. */
const FADE_PX = 15;

class Edge {
  readonly clip = document.createElement('div');
  readonly #strip = document.createElement('div');

  /** @param toward where its line of words leads */
  constructor(toward: 'right' | 'bottom') {
    const ends = `transparent, #000 ${FADE_PX}px, #000 calc(100% - ${FADE_PX}px), transparent`;
    this.clip.style.maskImage = `linear-gradient(to ${toward}, ${ends})`;
    this.clip.setAttribute('aria-hidden', 'true');
    Object.assign(this.clip.style, { position: 'absolute', overflow: 'hidden' });
    Object.assign(this.#strip.style, { position: 'absolute', inset: '0', willChange: 'transform' });
    this.clip.append(this.#strip);
  }

  /** @param vertical lines: along the upper edge */
  write(labels: readonly GridLabel[], vertical: boolean, colors: Palette): void {
    const { grid_label: color, ground } = colors;
    const halo = `-1px -1px 1px ${ground}, 1px -1px 1px ${ground}, -1px 1px 1px ${ground}, 1px 1px 1px ${ground}`;
    const spans = labels.map(({ text, at_px }) => {
      const span = document.createElement('span');
      span.textContent = text;
      Object.assign(span.style, {
        position: 'absolute',
        font: '600 12px/14px system-ui, sans-serif',
        whiteSpace: 'nowrap',
        color,
        textShadow: halo,
        left: vertical ? `${at_px + 4}px` : '8px',
        top: vertical ? '4px' : `${at_px - 16}px`,
      });
      return span;
    });
    this.#strip.replaceChildren(...spans);
  }

  move(x: number, y: number): void {
    this.#strip.style.transform = `translate(${x}px, ${y}px)`;
  }
}

export class GridLabels {
  readonly #along = { top: new Edge('right'), left: new Edge('bottom') };
  #drawn: View | null = null;
  #cover: Cover | null = null;
  #seen = true;

  get elements(): readonly HTMLElement[] {
    return [this.#along.top.clip, this.#along.left.clip];
  }

  write(view: View, origin: LatLon, colors: Palette): void {
    this.#drawn = view;
    const [columns, rows] = labels_of(view, origin, BEYOND_PX);
    this.#along.top.write(columns, true, colors);
    this.#along.left.write(rows, false, colors);
  }

  show(view: View, cover: Cover): void {
    const drawn = this.#drawn;
    // Turned, the lines cross the edges anywhere; the scale bar still tells distances.
    const seen = view.turn_rad === 0;
    if (seen !== this.#seen) {
      for (const { style } of this.elements) style.display = seen ? '' : 'none';
      this.#seen = seen;
    }
    if (!drawn || view.turn_rad !== 0) return;
    if (cover !== this.#cover || drawn === view) this.#clip(view, cover);
    const { top, left } = this.#along;
    // Inside of its clip, which begins at the panels.
    top.move(view.fit.e - drawn.fit.e - cover.left - 60, 0);
    left.move(0, view.fit.f - drawn.fit.f - cover.top - 20);
  }

  #clip(view: View, cover: Cover): void {
    this.#cover = cover;
    const px = (value: number): string => `${Math.max(0, value)}px`;
    const { top, left } = this.#along;
    Object.assign(top.clip.style, {
      left: px(cover.left + 60),
      top: px(cover.top),
      width: px(view.width_px - cover.left - cover.right - 120),
      height: '20px',
    });
    Object.assign(left.clip.style, {
      left: px(cover.left),
      top: px(cover.top + 20),
      width: '80px',
      height: px(view.height_px - cover.top - cover.bottom - 60),
    });
  }
}
