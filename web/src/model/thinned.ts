// A line as a screen can show it: without what lies outside of the screen, and without the points that
// nobody could tell from a straight line. Drawing costs by the points of a path, and a laid way has
// thousands.
//
//            ·
//   anchor ·────── · ──── ·      from the anchor on every point narrows the sector in which a straight
//                      ·         line passes all of them near enough; the first one outside of it
//                                makes the one before it the next anchor

/** What draws, as the context of a canvas does. */
export interface Pen {
  moveTo(x: number, y: number): void;
  lineTo(x: number, y: number): void;
}
/** Points by their number, pixels. */
export interface Points {
  x_px(k: number): number;
  y_px(k: number): number;
}
export interface Frame {
  readonly left: number;
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
}

/** A line may pass beside a point by so much. */
export const THIN_PX = 0.35;

/** On which sides of the frame a place lies, as bits. */
const sides_of = (frame: Frame, x: number, y: number): number =>
  (x < frame.left ? 1 : 0) |
  (x > frame.right ? 2 : 0) |
  (y < frame.top ? 4 : 0) |
  (y > frame.bottom ? 8 : 0);

/** The sector seen from an anchor, between two directions. */
class Sector {
  x = 0;
  y = 0;
  #low: readonly [number, number] | null = null;
  #high: readonly [number, number] = [0, 0];
  #far2 = 0;

  begin(x: number, y: number): void {
    [this.x, this.y] = [x, y];
    this.#low = null;
    this.#far2 = 0;
  }

  /** Takes one more point. @return false: a straight line to it would miss others, or come back */
  take(x: number, y: number): boolean {
    const [dx, dy] = [x - this.x, y - this.y];
    const d2 = dx * dx + dy * dy;
    if (d2 < this.#far2) return false;
    this.#far2 = d2;
    if (d2 <= THIN_PX * THIN_PX) return true;
    const low = this.#low;
    const high = this.#high;
    if (low && (low[0] * dy - low[1] * dx < 0 || dx * high[1] - dy * high[0] < 0)) return false;
    const sin = THIN_PX / Math.sqrt(d2);
    const cos = Math.sqrt(1 - sin * sin);
    const [low_x, low_y] = [dx * cos + dy * sin, dy * cos - dx * sin];
    const [high_x, high_y] = [dx * cos - dy * sin, dy * cos + dx * sin];
    if (!low || low[0] * low_y - low[1] * low_x > 0) this.#low = [low_x, low_y];
    if (!low || high_x * high[1] - high_y * high[0] > 0) this.#high = [high_x, high_y];
    return true;
  }
}

/**
 * Adds a line to a path that is only stroked: its pieces outside of the frame are left out.
 * @param first and @param end numbers of its points: from one up to before the other
 */
export const draw_thinned = (
  pen: Pen,
  points: Points,
  frame: Frame,
  first: number,
  end: number,
): void => {
  const sector = new Sector();
  let down = false;
  let [last_x, last_y] = [points.x_px(first), points.y_px(first)];
  let last_sides = sides_of(frame, last_x, last_y);
  for (let k = first + 1; k < end; k += 1) {
    const [x, y] = [points.x_px(k), points.y_px(k)];
    const sides = sides_of(frame, x, y);
    if ((sides & last_sides) !== 0) {
      if (down) pen.lineTo(last_x, last_y);
      down = false;
    } else {
      if (!down) {
        pen.moveTo(last_x, last_y);
        sector.begin(last_x, last_y);
        down = true;
      }
      if (!sector.take(x, y)) {
        pen.lineTo(last_x, last_y);
        sector.begin(last_x, last_y);
        sector.take(x, y);
      }
    }
    [last_x, last_y, last_sides] = [x, y, sides];
  }
  if (down) pen.lineTo(last_x, last_y);
};
