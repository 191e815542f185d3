// The click that a browser makes of a finger which is lifted after a hold. By then another button may
// stand where the held one was, and nobody has pressed that.

/** Browsers make it at once, or after looking for a second tap. */
const CLICK_AFTER_MS = 500;

/** Takes the click out that ends the press in hand, if it falls there: elsewhere, as on STOP, each one
 * counts. */
export const swallow_click = ({ left, right, top, bottom }: DOMRect): void => {
  const here = ({ clientX, clientY }: MouseEvent): boolean =>
    clientX >= left && clientX <= right && clientY >= top && clientY <= bottom;
  const eat = (event: MouseEvent): void => {
    if (!here(event)) return;
    event.preventDefault();
    event.stopPropagation();
  };
  const lifted = (event: PointerEvent): void => {
    if (event.type === 'pointerup' && !here(event)) return;
    for (const type of ['pointerup', 'pointercancel'] as const) {
      window.removeEventListener(type, lifted, true);
    }
    setTimeout(() => window.removeEventListener('click', eat, true), CLICK_AFTER_MS);
  };
  window.addEventListener('click', eat, true);
  window.addEventListener('pointerup', lifted, true);
  window.addEventListener('pointercancel', lifted, true);
};
