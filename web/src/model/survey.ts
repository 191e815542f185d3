// A field that is driven in tracks: what is asked for, and what would come of it.

import { fixed } from './figures';
import type { LatLon, Plan } from './plan';
import type { ImportedArea } from './ports';
import { say } from './say';

/** Tracks with rounds along the border; those rounds alone; rings to the middle. */
export type Pattern = 'tracks' | 'perimeter' | 'spiral';

export interface SurveyWish {
  readonly polygon: readonly LatLon[];
  /** Obstacles inside of it. */
  readonly holes: readonly (readonly LatLon[])[];
  readonly pattern: Pattern;
  /** Working width. */
  readonly spacing_m: number;
  /** Compass direction of the tracks; null: the one that costs least. */
  readonly direction_deg: number | null;
  readonly turn: 'pivot' | 'arc';
  /** Of arcs. */
  readonly radius_m: number;
  readonly headland_passes: number;
  /** Null: the vehicle's usual one. */
  readonly speed_mps: number | null;
}
export interface SurveyFigures {
  readonly direction_deg: number;
  readonly length_m: number;
  readonly time_s: number;
  readonly field_m2: number;
  /** Of the field, 0 to 1. */
  readonly covered_share: number;
  readonly tracks: number;
  readonly tight_turns: number;
  /** What was left out, and why. */
  readonly notes: readonly string[];
}
export interface Survey extends SurveyFigures {
  readonly plan: Plan;
}

/** Why there is nothing to work out yet. */
export const why_not_survey = (wish: SurveyWish): string | null => {
  const missing = 3 - wish.polygon.length;
  if (missing === 3) return say('tap_the_corners_of_the_field_on_the');
  if (missing > 0) return say('more_corners_needed', { n: missing });
  const poor = wish.holes.findIndex((hole) => hole.length < 3);
  return poor < 0 ? null : say('obstacle_poor_needs_three_corners', { poor: poor + 1 });
};

/** The corners of a field that came in a file, and of its holes, without the last ones, which close
 * them. */
export const field_rings = ({ polygon }: ImportedArea): LatLon[][] =>
  polygon.coordinates.map((ring) => ring.slice(0, -1).map(([lon = 0, lat = 0]) => ({ lat, lon })));

/** "1.25 ha", "340 m²". */
export const area_text = (m2: number): string =>
  m2 >= 10_000 ? `${fixed(m2 / 10_000, 2)} ha` : `${fixed(m2, 0)} m²`;

/** Never rounded up to all of it. */
export const share_text = (share: number): string =>
  `${fixed(Math.floor(share * 1000 + 1e-6) / 10, 1)} %`;
