// Where something lies that is out of sight: the spot on the border of what is seen that points to it.

export interface Box {
  readonly left: number;
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
}
export interface EdgeSpot {
  readonly x: number;
  readonly y: number;
  /** Clockwise from the right, as a canvas turns. */
  readonly angle_rad: number;
}

/**
 * @param box where the spot may be, pixels; without room there is none
 * @return null: the place is inside, and is seen
 */
export const edge_spot = (box: Box, x: number, y: number): EdgeSpot | null => {
  const [half_x, half_y] = [(box.right - box.left) / 2, (box.bottom - box.top) / 2];
  if (half_x <= 0 || half_y <= 0) return null;
  const [middle_x, middle_y] = [box.left + half_x, box.top + half_y];
  const [dx, dy] = [x - middle_x, y - middle_y];
  const beyond = Math.max(Math.abs(dx) / half_x, Math.abs(dy) / half_y);
  if (!(beyond > 1) || !Number.isFinite(beyond)) return null;
  return {
    x: middle_x + dx / beyond,
    y: middle_y + dy / beyond,
    angle_rad: Math.atan2(dy, dx),
  };
};
