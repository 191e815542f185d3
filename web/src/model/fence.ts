// Where the robot must stay, where it must not go, and where it may wait in need.

import { fixed } from './figures';
import { area_m2, type Places } from './outline';
import type { LatLon } from './plan';
import { say, told } from './say';

export type AreaKind = 'inclusion' | 'exclusion';
export interface Circle extends LatLon {
  readonly radius_m: number;
}
/** Exactly one of the two. */
export interface FenceArea {
  readonly kind: AreaKind;
  readonly polygon?: Places;
  readonly circle?: Circle;
}
export interface FenceDraft {
  readonly name: string;
  readonly areas: readonly FenceArea[];
  readonly rally: Places;
}
export interface Fence extends FenceDraft {
  readonly id: string;
  readonly revision: number;
  readonly active: boolean;
}
export interface FenceSummary {
  readonly id: string;
  readonly revision: number;
  readonly name: string;
  /** How many. */
  readonly areas: number;
  readonly rally: number;
  readonly active: boolean;
  readonly updated: string;
}

export const area_words: Record<AreaKind, string> = told({
  inclusion: 'stay_inside',
  exclusion: 'keep_out',
});

const NEAR_M = 10;

/** How near its limit is, as soon as that matters; null: it does not. @param distance_m negative outside */
export const fence_near = (
  fence: { readonly inside: boolean; readonly distance_m: number | null } | null,
): string | null => {
  if (!fence) return null;
  const { inside, distance_m } = fence;
  if (!inside || (distance_m ?? 0) < 0) return say('is_outside_the_fence');
  return distance_m === null || distance_m >= NEAR_M
    ? null
    : say('fence_in', { distance: fixed(distance_m, 1) });
};

export const NEW_FENCE: FenceDraft = {
  get name() {
    return say('new_fence');
  },
  areas: [],
  rally: [],
};
const FRESH_RADIUS_M = 5;

export const area_size_m2 = ({ polygon, circle }: FenceArea): number =>
  circle ? Math.PI * circle.radius_m ** 2 : area_m2(polygon ?? []);

/** The points of an area that are taken by hand: its corners, or its middle. */
export const area_places = ({ polygon, circle }: FenceArea): Places =>
  polygon ?? (circle ? [{ lat: circle.lat, lon: circle.lon }] : []);

/** The area with its corners, or its middle, elsewhere. Of a circle the last place counts. */
export const with_places = (area: FenceArea, places: Places): FenceArea => {
  if (!area.circle) return { kind: area.kind, polygon: places };
  const { lat, lon } = places.at(-1) ?? area.circle;
  return { kind: area.kind, circle: { lat, lon, radius_m: area.circle.radius_m } };
};

export const fresh_circle = (kind: AreaKind, at: LatLon): FenceArea => ({
  kind,
  circle: { lat: at.lat, lon: at.lon, radius_m: FRESH_RADIUS_M },
});

/** Why it cannot be kept yet. */
export const why_not_keep = (fence: FenceDraft): string | null => {
  if (fence.name.trim() === '') return say('give_the_fence_a_name');
  const poor = fence.areas.findIndex(({ polygon }) => polygon && polygon.length < 3);
  if (poor >= 0) return say('area_poor_needs_three_corners', { poor: poor + 1 });
  if (fence.areas.length + fence.rally.length === 0) return say('draw_an_area_or_a_rally_point');
  return null;
};
