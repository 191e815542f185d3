// How a circle lies on the ground: entered along its tangent where the way to it comes from outside.
// The robot lays it likewise; here it is for drawing. One plane, any unit; angles about the centre,
// radians, counter-clockwise from the x axis.

import type { LatLon } from './plan';

/** LOITER: farther away than the radius it drives back. */
export interface StayGoal extends LatLon {
  readonly radius_m?: number;
}
/** CIRCLE: without turns it has no end. */
export interface CircleGoal extends LatLon {
  readonly radius_m: number;
  readonly turns?: number;
  readonly clockwise?: boolean;
}

export interface CircleWay {
  readonly from_rad: number;
  /** The whole way round; counter-clockwise positive, whole turns counted. */
  readonly sweep_rad: number;
  /** The way to it goes on along it. */
  readonly tangent: boolean;
}

export interface CircleWish {
  readonly radius: number;
  readonly clockwise: boolean;
  readonly turns: number;
  /** Nearer to it than this there is no tangent to drive. */
  readonly on: number;
}

/** @param before where the way to it begins, from its centre; null: not known */
export const circle_way = (
  { radius, clockwise, turns, on }: CircleWish,
  before: readonly [x: number, y: number] | null,
): CircleWay => {
  const side = clockwise ? -1 : 1;
  const sweep_rad = side * 2 * Math.PI * turns;
  const far = before ? Math.hypot(before[0], before[1]) : 0;
  if (!before || far === 0) return { from_rad: Math.PI / 2, sweep_rad, tangent: false };
  const towards_rad = Math.atan2(before[1], before[0]);
  if (far < radius + on) return { from_rad: towards_rad, sweep_rad, tangent: false };
  return { from_rad: towards_rad + side * Math.acos(radius / far), sweep_rad, tangent: true };
};
