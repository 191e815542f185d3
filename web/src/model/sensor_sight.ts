// What one sensor sees now, from above: the robot looks up, its origin in the middle.

import { metres } from './format';
import { say } from './say';
import type { SeenScan, Sensor, SensorDots } from './seen';

export const DOT_KINDS = ['obstacle', 'overhang', 'drop', 'passing'] as const;
export type DotKind = (typeof DOT_KINDS)[number];
/** Right and down, metres. */
type At = readonly [right_m: number, down_m: number];
export interface Sight {
  readonly dots: Readonly<Record<DotKind, readonly At[]>>;
  /** Half of the picture's width. */
  readonly reach_m: number;
  /** Where it stands on the robot, and which way it looks: degrees clockwise from straight ahead. */
  readonly mount: At;
  readonly looks_deg: number;
  /** To the nearest dot, from the robot's origin; null: it sees nothing that stands there. */
  readonly nearest_m: number | null;
}

/** Rings stand at these; the picture reaches to one of them. */
const REACHES_M = [2, 5, 10, 20, 40] as const;
/** Older than this it is not what the sensor sees now. */
export const SIGHT_OLD_S = 1;

const pairs = (cm: readonly number[]): At[] => {
  const found: At[] = [];
  for (let k = 0; k + 1 < cm.length; k += 2) {
    found.push([-(cm[k + 1] ?? 0) / 100, -(cm[k] ?? 0) / 100]);
  }
  return found;
};
const far_m = ([right_m, down_m]: At): number => Math.hypot(right_m, down_m);

/** Three quarters of the dots are in the picture: a single far one does not shrink the rest. */
const reach_of = (distances_m: readonly number[]): number => {
  const sorted = [...distances_m].sort((a, b) => a - b);
  const most = sorted[Math.floor(0.75 * (sorted.length - 1))] ?? 0;
  return REACHES_M.find((reach) => reach >= 1.1 * most) ?? REACHES_M[REACHES_M.length - 1] ?? 40;
};

/** @param scan the newest; null: nothing came. @return null: it tells nothing of this sensor now */
export const sight_of = ({ name, mount }: Sensor, scan: SeenScan | null): Sight | null => {
  const mine: SensorDots | undefined = scan?.sensors.find(({ sensor }) => sensor === name);
  if (!mine || mine.age_s > SIGHT_OLD_S) return null;
  const dots = {
    obstacle: pairs(mine.obstacle_cm),
    overhang: pairs(mine.overhang_cm),
    drop: pairs(mine.drop_cm),
    passing: pairs(mine.passing_cm),
  };
  const distances_m = DOT_KINDS.flatMap((kind) => dots[kind]).map(far_m);
  return {
    dots,
    reach_m: reach_of(distances_m),
    mount: [-mount.y_m, -mount.x_m],
    looks_deg: -mount.yaw_deg,
    nearest_m: distances_m.length === 0 ? null : distances_m.reduce((a, b) => Math.min(a, b)),
  };
};

/** What the picture shows, in words. */
export const sight_words = (sight: Sight | null): string => {
  if (sight === null) return say('sight_nothing_new');
  const n = DOT_KINDS.reduce((sum, kind) => sum + sight.dots[kind].length, 0);
  return sight.nearest_m === null
    ? say('sight_free')
    : say('sight_nearest', { n, nearest: metres(sight.nearest_m), reach: metres(sight.reach_m) });
};
