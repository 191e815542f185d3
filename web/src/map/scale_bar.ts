// The scale bar: a length of 1, 2 or 5 × 10ⁿ metres that fits, in a DOM element of its own so that
// it can be read out and styled.

import { round_step_below } from '../model/geo';
import { language_now, say } from '../model/say';

const LONGEST_PX = 110;

export interface ScaleBar {
  readonly element: HTMLElement;
  /** @param pixel_m metres on the ground of one CSS pixel */
  show(pixel_m: number): void;
}

export const make_scale_bar = (): ScaleBar => {
  const element = document.createElement('div');
  element.className = 'scale-bar';
  element.setAttribute('role', 'img');
  let shown = '';
  return {
    element,
    show: (pixel_m) => {
      const length_m = round_step_below(LONGEST_PX * pixel_m);
      const text =
        length_m >= 1000
          ? `${length_m / 1000} km`
          : length_m >= 1
            ? `${length_m} m`
            : `${Math.round(length_m * 100)} cm`;
      const width = `${(length_m / pixel_m).toFixed(1)}px`;
      const now = `${text} ${width} ${language_now()}`;
      if (shown === now) return;
      shown = now;
      element.textContent = text;
      element.style.width = width;
      element.setAttribute('aria-label', say('scale_this_bar_is', { length: text }));
    },
  };
};
