// The way through the loaded mission, as the robot laid it.

import type { LatLon } from './plan';

/** The loaded mission as it is laid out: corners rounded, dense points smoothed. */
export interface MissionWay {
  readonly mission_id: string;
  readonly revision: number;
  readonly line: readonly LatLon[];
  readonly pace: readonly WayPace[];
  readonly stops: readonly WayStop[];
}
/** A place of the way, and how it is driven from there to the next one. */
export interface WayPace extends LatLon {
  readonly distance_m: number;
  /** As planned, here: with bends, speeding up and braking. */
  readonly speed_mps: number;
  /** The most that item, bend and vehicle allow. */
  readonly set_mps: number;
  /** That is driven to, from 1. */
  readonly item: number;
}
/** Where it stops; with how it turns on the spot there. */
export interface WayStop extends LatLon {
  readonly distance_m: number;
  /** From 1. */
  readonly item: number;
  readonly turns: readonly {
    /** Null: as it comes there. */
    readonly from_heading_deg: number | null;
    readonly to_heading_deg: number;
    /** Clockwise positive. */
    readonly turn_deg: number | null;
    /** From nobody knows where: only if it points away by more than this. */
    readonly above_deg: number;
  }[];
}
