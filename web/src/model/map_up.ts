// Which way the map is turned: north up, or the way that the robot looks.

export type MapUp = 'north' | 'heading';

/** Smaller changes are the heading's own noise. */
const STILL_DEG = 2;

export interface TurnWanted {
  readonly up: MapUp;
  /** A map that is drawn on does not turn under the finger. */
  readonly drawn_on: boolean;
  /** The robot is kept in the middle. */
  readonly follows: boolean;
  /** Null: it is not known, or was known long ago. */
  readonly heading_deg: number | null;
}

/** @return in (−180°, 180°] */
const wrapped_deg = (angle_deg: number): number => {
  const rest = ((angle_deg % 360) + 360) % 360;
  return rest > 180 ? rest - 360 : rest;
};

/** Radians, in (−π, π]. */
export const angle_between = (from_rad: number, to_rad: number): number =>
  (wrapped_deg(((to_rad - from_rad) * 180) / Math.PI) * Math.PI) / 180;

/** Clockwise, where y points down. */
export const turned = (
  [x, y]: readonly [number, number],
  angle_rad: number,
): readonly [x: number, y: number] => {
  const [sin, cos] = [Math.sin(angle_rad), Math.cos(angle_rad)];
  return [x * cos - y * sin, x * sin + y * cos];
};

/** By how much the map is to be turned, clockwise. @param now by how much it is */
export const turn_deg = (now: number, wanted: TurnWanted): number => {
  if (wanted.up === 'north' || wanted.drawn_on) return 0;
  // Whoever looks at another place, or waits for the heading, keeps what he sees as it lies.
  if (!wanted.follows || wanted.heading_deg === null) return now;
  const next = wrapped_deg(-wanted.heading_deg);
  return Math.abs(wrapped_deg(next - now)) < STILL_DEG ? now : next;
};
