// A field that is driven in tracks: what is asked for, and what would come of it.

import type { LatLon, Plan } from './plan';
import type { ImportedArea } from './ports';

export interface SurveyWish {
  readonly polygon: readonly LatLon[];
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
  if (missing === 3) return 'Tap the corners of the field on the map.';
  if (missing > 0) return `${missing} more ${missing === 1 ? 'corner' : 'corners'} needed.`;
  return null;
};

/** The corners of a field that came in a file, without the last one, which closes it. */
export const field_places = ({ polygon }: ImportedArea): LatLon[] => {
  const ring = polygon.coordinates[0] ?? [];
  return ring.slice(0, -1).map(([lon = 0, lat = 0]) => ({ lat, lon }));
};

/** "1.25 ha", "340 m²". */
export const area_text = (m2: number): string =>
  m2 >= 10_000 ? `${(m2 / 10_000).toFixed(2)} ha` : `${m2.toFixed(0)} m²`;

/** Never rounded up to all of it. */
export const share_text = (share: number): string =>
  `${(Math.floor(share * 1000 + 1e-6) / 10).toFixed(1)} %`;
