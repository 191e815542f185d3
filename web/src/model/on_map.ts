// What the hand on the map and the editor say to each other.

import type { LatLon } from './plan';

/** Exactly one is active: look; move and select; also add with every tap; choose several; show how it
 * stands. */
export type MapMode = 'watch' | 'edit' | 'draw' | 'pick' | 'point';

/** What a line beside the edited mission means: how it was, another mission, somebody else's; what was
 * added and what is gone; what became of a file's rows, and which of them is looked at; or of what it was
 * made. */
export type BesideTone =
  | 'before'
  | 'other'
  | 'theirs'
  | 'added'
  | 'gone'
  | 'taken'
  | 'changed'
  | 'left_out'
  | 'looked'
  | 'drawn';
/** Around is wider than a ring: both are seen at one place. */
export type PointMark = 'ring' | 'cross' | 'around';
export interface LineOnMap {
  readonly places: readonly LatLon[];
  readonly tone: BesideTone;
  /** So at each of the places, that nothing joins. */
  readonly points?: PointMark;
}

/** How what is edited hangs together. */
export type PlanShape = 'line' | 'ring' | 'points';

export interface MapEvents {
  on_add(at: LatLon): void;
  on_insert(index: number, at: LatLon): void;
  on_move(index: number, to: LatLon): void;
  on_select(index: number | null): void;
  /** One more of several, or one less. */
  on_pick(index: number): void;
  on_pick_box(indices: readonly number[]): void;
  /** Free ground was tapped while nothing is edited; or any place was pressed for long. */
  on_place(at: LatLon): void;
  /** @param toward where the finger is that was put down there; null: it has not moved */
  on_point(at: LatLon | null, toward: LatLon | null): void;
  /** The person moved the map: following ends. */
  on_pan(): void;
}

/** Nobody listens. */
export const NO_EVENTS: MapEvents = {
  on_add: () => undefined,
  on_insert: () => undefined,
  on_move: () => undefined,
  on_select: () => undefined,
  on_pick: () => undefined,
  on_pick_box: () => undefined,
  on_place: () => undefined,
  on_point: () => undefined,
  on_pan: () => undefined,
};

/** What the map shows of an edit, besides the plan itself. */
export interface EditView {
  /** Items of it that are chosen together. */
  show_picked(picked: ReadonlySet<number>): void;
  /** Lines to compare it with. A dragged point is caught by those of other missions. */
  show_beside(beside: readonly LineOnMap[]): void;
  /** A dragged point is caught by what lies near. */
  set_snap(snaps: boolean): void;
}
