// Over which ground the vehicle comes before it stands, driving on as it was told: the same figures
// as the guard's on the robot, for the eye only.

import { place_on_body } from './obstacle';
import type { LatLon } from './plan';

/** By what the guard reckons. */
export interface GuardFigures {
  /** From the vehicle's origin to its rear end. */
  readonly back_m: number;
  readonly side_m: number;
  readonly gap_m: number;
  readonly delay_s: number;
  readonly decel_mps2: number;
  readonly turn_decel_dps2: number;
}
export interface Twist {
  readonly speed_mps: number;
  /** Counter-clockwise positive. */
  readonly yaw_rate_dps: number;
}
export interface Size {
  readonly length_m: number;
  readonly width_m: number;
}
/** The vehicle's outlines, one after the other, and the room that is kept free at the last. */
export interface Sweep {
  readonly outlines: readonly (readonly LatLon[])[];
  readonly margin: readonly LatLon[];
}

const RAD = Math.PI / 180;
const STEPS = 12;
const STANDS = 0.01;

/** How long the twist goes on until the vehicle stands: the delay, and half of what braking takes. */
export const stopping_s = (twist: Twist, guard: GuardFigures): number =>
  guard.delay_s +
  Math.max(
    Math.abs(twist.speed_mps) / (2 * guard.decel_mps2),
    Math.abs(twist.yaw_rate_dps) / (2 * guard.turn_decel_dps2),
  );

export interface Pose {
  readonly ahead_m: number;
  readonly left_m: number;
  readonly turn_rad: number;
}

/** Along the arc of a twist, on the body as it stands now. */
export const along = ({ speed_mps, yaw_rate_dps }: Twist, seconds: number): Pose => {
  const turn_rad = yaw_rate_dps * RAD * seconds;
  const way_m = speed_mps * seconds;
  if (Math.abs(turn_rad) < 1e-6) return { ahead_m: way_m, left_m: 0, turn_rad };
  return {
    ahead_m: (way_m * Math.sin(turn_rad)) / turn_rad,
    left_m: (way_m * (1 - Math.cos(turn_rad))) / turn_rad,
    turn_rad,
  };
};

/** Corners of the vehicle in a pose, grown by some room. */
const box = (
  { length_m, width_m }: Size,
  back_m: number,
  pose: Pose,
  grown: { readonly side_m: number; readonly front_m: number; readonly rear_m: number },
): readonly (readonly [ahead_m: number, left_m: number])[] => {
  const front = length_m - back_m + grown.front_m;
  const rear = -back_m - grown.rear_m;
  const half = width_m / 2 + grown.side_m;
  const [cos, sin] = [Math.cos(pose.turn_rad), Math.sin(pose.turn_rad)];
  const corners = [
    [front, half],
    [rear, half],
    [rear, -half],
    [front, -half],
  ] as const;
  return corners.map(([x, y]) => [
    pose.ahead_m + cos * x - sin * y,
    pose.left_m + sin * x + cos * y,
  ]);
};

const NONE = { side_m: 0, front_m: 0, rear_m: 0 };

/** Null: it stands, or nobody knows where. */
export const sweep_of = (
  at: LatLon | null,
  heading_deg: number | null,
  twist: Twist,
  size: Size,
  guard: GuardFigures,
): Sweep | null => {
  const stands = Math.abs(twist.speed_mps) < STANDS && Math.abs(twist.yaw_rate_dps) < 1;
  if (at === null || heading_deg === null || stands) return null;
  const end_s = stopping_s(twist, guard);
  const on_map = (corners: ReturnType<typeof box>): readonly LatLon[] =>
    corners.map(([ahead, left]) => place_on_body(at, heading_deg, ahead, left));
  const outlines = Array.from({ length: STEPS + 1 }, (_, k) =>
    on_map(box(size, guard.back_m, along(twist, (end_s * k) / STEPS), NONE)),
  );
  const gap = twist.speed_mps >= 0 ? [guard.gap_m, 0] : [0, guard.gap_m];
  const [front_m = 0, rear_m = 0] = gap;
  const grown = { side_m: guard.side_m, front_m, rear_m };
  return { outlines, margin: on_map(box(size, guard.back_m, along(twist, end_s), grown)) };
};
