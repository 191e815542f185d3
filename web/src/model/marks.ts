// Landmarks, walls and tags that the robot knows about its body, and what its cameras' programs told, as
// rows of a table.

import { age, metres } from './format';
import { say } from './say';

export interface Spot {
  readonly ahead_m: number;
  readonly left_m: number;
}
interface Kept {
  readonly id: number;
  readonly sigma_m: number;
  readonly age_s: number;
}
export interface KnownMarks {
  readonly landmarks: readonly (Kept &
    Spot & {
      readonly name: string | null;
      readonly radius_m: number | null;
      readonly source: 'scan' | 'vision' | 'both';
      readonly believed: boolean;
    })[];
  readonly walls: readonly (Kept & {
    readonly source: 'scan' | 'vision';
    readonly believed: boolean;
    readonly distance_m: number;
    readonly from: Spot;
    readonly to: Spot;
  })[];
  readonly tags: readonly (Kept & Spot & { readonly camera: string })[];
  readonly obstacles: readonly (Spot & { readonly sensor: string; readonly age_s: number })[];
  readonly planes: readonly (Spot & {
    readonly sensor: string;
    readonly size: number;
    readonly age_s: number;
  })[];
}

export interface MarkRow {
  readonly key: string;
  readonly what: string;
  readonly where: string;
  readonly by: string;
  readonly age: string;
  /** Items drive by it. Null: nothing does, whatever is believed. */
  readonly believed: boolean | null;
}

/** "3.20 m ahead, 0.90 m left". */
export const spot_words = ({ ahead_m, left_m }: Spot): string => {
  const along = say(ahead_m < 0 ? 'metres_behind' : 'metres_ahead', {
    metres: metres(Math.abs(ahead_m)),
  });
  const across = `${metres(Math.abs(left_m))} ${say(left_m < 0 ? 'side_right' : 'side_left')}`;
  return `${along}, ${across}`;
};

const sure = (where: string, sigma_m: number): string => `${where} ±${metres(sigma_m)}`;

/** A line that ends far away is still told where it passes. */
const wall_words = (from: Spot, to: Spot): string =>
  metres(Math.hypot(to.ahead_m - from.ahead_m, to.left_m - from.left_m));

export const mark_rows = (marks: KnownMarks): MarkRow[] => [
  ...marks.landmarks.map((mark) => ({
    key: `l${mark.id}`,
    what: mark.name ?? `${say('landmark')} ${mark.id}`,
    where: sure(spot_words(mark), mark.sigma_m),
    by: say(`seen_by_${mark.source}`),
    age: age(mark.age_s),
    believed: mark.believed,
  })),
  ...marks.walls.map((wall) => ({
    key: `w${wall.id}`,
    what: `${say('wall')} ${wall.id}, ${wall_words(wall.from, wall.to)}`,
    where: sure(metres(wall.distance_m), wall.sigma_m),
    by: say(`seen_by_${wall.source}`),
    age: age(wall.age_s),
    believed: wall.believed,
  })),
  ...marks.tags.map((tag) => ({
    key: `t${tag.id}`,
    what: `${say('tag_mark')} ${tag.id}`,
    where: sure(spot_words(tag), tag.sigma_m),
    by: tag.camera,
    age: age(tag.age_s),
    believed: null,
  })),
  ...marks.obstacles.map((spot, k) => ({
    key: `o${k}`,
    what: say('camera_obstacle'),
    where: spot_words(spot),
    by: spot.sensor,
    age: age(spot.age_s),
    believed: null,
  })),
  ...marks.planes.map((plane, k) => ({
    key: `p${k}`,
    what: say('camera_plane', { points: plane.size }),
    where: spot_words(plane),
    by: plane.sensor,
    age: age(plane.age_s),
    believed: null,
  })),
];
