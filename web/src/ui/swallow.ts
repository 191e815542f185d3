// The click that a browser makes of a finger which is lifted after a hold. By then another button may
// stand where the held one was, and nobody has pressed that.

/** Browsers make it at once, or after looking for a second tap. */
const CLICK_AFTER_MS = 500;

/** Takes the click out that ends the press in hand, if it falls there: elsewhere, as on STOP, each one
 * counts, and so does whatever begins with a press of its own. */
export const swallow_click = ({ left, right, top, bottom }: DOMRect): void => {
  const eat = (event: MouseEvent): void => {
    const { clientX: x, clientY: y } = event;
    if (x < left || x > right || y < top || y > bottom) return;
    event.preventDefault();
    event.stopPropagation();
  };
  const done = (): void => {
    window.removeEventListener('click', eat, true);
    window.removeEventListener('pointerdown', done, true);
    window.removeEventListener('pointerup', lifted, true);
    window.removeEventListener('pointercancel', done, true);
  };
  const lifted = (): void => {
    setTimeout(done, CLICK_AFTER_MS);
  };
  window.addEventListener('click', eat, true);
  window.addEventListener('pointerdown', done, true);
  window.addEventListener('pointerup', lifted, true);
  window.addEventListener('pointercancel', done, true);
};
