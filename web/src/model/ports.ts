// What the rooms of the page hand each other through main.ts: types only.

import type { Answer, Refusal } from './answer';
import type { Calibration, CalibrationKind, SpaceOnMap } from './calibration';
import type { CircleGoal, StayGoal } from './circle';
import type { ControlState } from './control';
import type { SendDrive, SendThrottle } from './drive';
import type { MissionWay } from './laid_way';
import type { Drill, DrillOnMap, DrillWish } from './drill';
import type { Driver } from './drivers';
import type { Fence, FenceDraft, FenceSummary } from './fence';
import type { LinkHealth } from './freshness';
import type { Ground } from './ground';
import type { Halt } from './halt';
import type { Heat } from './heat';
import type { WayHome } from './homeward';
import type { MapUp } from './map_up';
import type { MeOnMap } from './me';
import type { EditView, MapEvents, MapMode, PlanShape } from './on_map';
import type { Home, KeptDrawing, LatLon, Plan, Settings, Item } from './plan';
import type { Revision } from './revision';
import type { DriveOnMap, SpeedsSet } from './route_drive';
import type { RowBlock, RowsWish } from './row_block';
import type { RunOnMap } from './run_ports';
import type { SeenEvents, SeenLink, SeenMap } from './seen';
import type { SiteMapView, StandingPose } from './site_map';
import type { KeptPlaces } from './known_places';
import type { ReceiverSky } from './sky';
import type { Survey, SurveyWish } from './survey';
import type { Remembered, Tracks } from './tracks';
import type { Bounds } from './tiling';
import type { TrailShades } from './trail_shades';
import type {
  Capabilities,
  Check,
  Position,
  Preview,
  SmoothedItems,
  StationEvent,
  Vehicle,
} from './vehicle';

export type { BesideTone, LineOnMap, MapEvents, MapMode, PlanShape } from './on_map';

/** One stored revision. */
export interface Mission {
  readonly id: string;
  readonly revision: number;
  readonly name: string;
  readonly items: readonly Item[];
  readonly home: Home | null;
  readonly settings: Settings;
  readonly frame?: NonNullable<Plan['frame']>;
  readonly drawing?: KeptDrawing;
  readonly updated: string;
}
export interface MissionSummary {
  readonly id: string;
  readonly revision: number;
  readonly name: string;
  readonly items: number;
  readonly length_m: number;
  readonly updated: string;
  readonly tags?: readonly string[];
  readonly archived?: boolean;
}
/** Which missions a list shows; deleted ones can still be brought back. */
export type Place = 'present' | 'archive' | 'deleted';
export interface MissionFilter {
  readonly place: Place;
  /** A part of the name; empty: any. */
  readonly name: string;
  /** Empty: any. */
  readonly tag: string;
}
export interface Finding {
  readonly severity: 'error' | 'warning';
  /** What it is about, for programs: `outside_fence`, `safety_parameter`. */
  readonly code: string;
  /** From 1; null: the mission as a whole. */
  readonly item: number | null;
  readonly detail: string;
}
/** What speaks against driving a mission here and now. */
export interface CheckReport {
  /** No errors: it can be loaded. */
  readonly ready: boolean;
  readonly findings: readonly Finding[];
  /** Null: an item goes as far as it sees. */
  readonly length_m: number | null;
  /** Null: likewise, or it has no end. */
  readonly time_s: number | null;
  readonly energy_wh: number | null;
  /** Of a full battery. */
  readonly battery_pct: number | null;
  readonly smoothed: readonly SmoothedItems[];
}
export interface Page<T> {
  readonly items: readonly T[];
  readonly next_cursor: string | null;
}
export interface ImportEntry {
  /** "line 3", "/mission/items/2" … */
  readonly row: string;
  /** What stands there. */
  readonly what: string;
  readonly outcome: 'taken' | 'changed' | 'left_out';
  readonly item: number | null;
  /** Which one has the item, from 1. */
  readonly mission: number | null;
  readonly reason: string;
}
/** A polygon of a file: a field that can be covered. */
export interface ImportedArea {
  readonly name: string;
  readonly row: string;
  /** Rings of [lon, lat], closed; the first is the field, the others are holes. */
  readonly polygon: { readonly coordinates: readonly (readonly (readonly number[])[])[] };
}
export interface ImportResult {
  readonly format: string;
  /** The first one; null: there is nothing to drive in the file. */
  readonly mission: Mission | null;
  /** All that were made. */
  readonly missions: readonly { readonly id: string; readonly name: string }[];
  readonly fence_id: string | null;
  readonly areas: readonly ImportedArea[];
  readonly taken: number;
  readonly changed: number;
  readonly left_out: number;
  readonly report: readonly ImportEntry[];
}
/** Where a mission begins: its first item, the nearest one, or an item's number. */
export type StartFrom = 'first' | 'nearest' | number;

export interface ImportHints {
  /** Of a file in metres that tells none itself. */
  readonly origin: LatLon | null;
  /** Positions that cannot be are left out; otherwise they refuse the file. */
  readonly rest: boolean;
}

export interface MissionCalls {
  list(filter: MissionFilter, cursor: string | null): Promise<Answer<Page<MissionSummary>>>;
  read(id: string): Promise<Answer<Mission>>;
  read_revision(id: string, revision: number): Promise<Answer<Mission>>;
  /** Newest first. */
  revisions(id: string, cursor: string | null): Promise<Answer<Page<Revision>>>;
  /** Makes an old state the newest one. @param revision the present one; @param to the old one */
  revert(id: string, revision: number, to: number): Promise<Answer<Mission>>;
  /** @param key asked again with it and the same plan, the first answer comes again */
  create(plan: Plan, key?: string): Promise<Answer<Mission>>;
  replace(id: string, revision: number, plan: Plan): Promise<Answer<Mission>>;
  remove(id: string, revision: number): Promise<Answer<null>>;
  /** Other tags, into the archive or out of it; what is left out stays. */
  describe(
    id: string,
    revision: number,
    change: { readonly tags?: readonly string[]; readonly archived?: boolean },
  ): Promise<Answer<Mission>>;
  copy(id: string): Promise<Answer<Mission>>;
  /** Brings a deleted mission back. */
  restore(id: string, revision: number): Promise<Answer<Mission>>;
  check(id: string, revision: number): Promise<Answer<CheckReport>>;
  /** @param origin of a table in metres that does not tell its own */
  import_file(file: File, hints: ImportHints): Promise<Answer<ImportResult>>;
  export_address(id: string, format: string): string;
  /** Why there is no file; null: there is one. */
  export_refusal(id: string, format: string): Promise<Refusal | null>;
}
/** A place to drive to. */
export interface Goal extends LatLon {
  /** How it faces there; left out: as it comes. */
  readonly heading_deg?: number;
  readonly reverse?: boolean;
}
/** A mission that was under way when the program on the robot ended. */
export interface LeftBehind {
  readonly mission_id: string;
  readonly revision: number;
  readonly name: string;
  readonly item: number | null;
  readonly items: number;
  readonly time: string;
}
export interface VehicleCalls {
  /** What stops or slows: sent at once, beside whatever else is under way. */
  halt(halt: Halt, signal: AbortSignal): Promise<Answer<unknown>>;
  vehicle(): Promise<Answer<Vehicle>>;
  /** @param by_hand the position need not be known: nothing drives by itself before it is */
  arm(by_hand: boolean): Promise<Answer<unknown>>;
  set_mode(mode: string): Promise<Answer<unknown>>;
  go_to(goal: Goal): Promise<Answer<unknown>>;
  dock(goal: Goal & { readonly heading_deg: number }): Promise<Answer<unknown>>;
  loiter(goal: StayGoal): Promise<Answer<unknown>>;
  circle(goal: CircleGoal): Promise<Answer<unknown>>;
  /** @param forward_m negative: backwards */
  move(forward_m: number): Promise<Answer<unknown>>;
  /** @param turn_deg clockwise positive */
  turn(turn_deg: number): Promise<Answer<unknown>>;
  set_home(at: LatLon): Promise<Answer<unknown>>;
  /** Where the robot stands, as a person says it. */
  stand_at(pose: StandingPose): Promise<Answer<unknown>>;
  reset_estop(): Promise<Answer<unknown>>;
  /** A person has looked where the robot stands. */
  acknowledge(): Promise<Answer<unknown>>;
  /** Which place counts, after the receiver's positions moved. @param keep the old one */
  settle_shift(keep: boolean): Promise<Answer<unknown>>;
  /** What a calibration drive needs, does and measured. */
  calibration(): Promise<Answer<Calibration>>;
  calibrate(kind: CalibrationKind): Promise<Answer<Calibration>>;
  /** @param keep what was measured acts from now on; else it is dropped */
  settle_calibration(keep: boolean): Promise<Answer<Calibration>>;
  forget_calibration(): Promise<Answer<Calibration>>;
  /** Takes from the two antennas' headings what they were measured to be off. */
  correct_antennas(): Promise<Answer<unknown>>;
  /** The way so far. */
  trail(): Promise<Answer<Remembered>>;
  drivers(): Promise<Answer<Page<Driver>>>;
  satellites(): Promise<Answer<{ receivers: readonly ReceiverSky[] }>>;
  restart_driver(name: string): Promise<Answer<unknown>>;
  /** What a way home would do now. */
  way_home(mode: 'RTL' | 'SMART_RTL'): Promise<Answer<WayHome>>;
  /** Goes on with what the radio interrupted. */
  go_on(): Promise<Answer<unknown>>;
  checks(): Promise<Answer<{ ready: boolean; checks: readonly Check[] }>>;
  load(mission_id: string, revision: number): Promise<Answer<unknown>>;
  preview(from: StartFrom): Promise<Answer<Preview>>;
  /** The way through the loaded mission, as it will be driven. */
  mission_way(): Promise<Answer<MissionWay>>;
  /** What bounds the speed of a mission, and what holds where it says nothing. */
  speeds_set(): Promise<SpeedsSet>;
  start(mission_id: string, revision: number, from: StartFrom): Promise<Answer<Preview>>;
  resume(): Promise<Answer<unknown>>;
  skip(): Promise<Answer<unknown>>;
  left_behind(): Promise<Answer<LeftBehind | null>>;
  forget_left_behind(): Promise<Answer<null>>;
  /** Events of the last hour, oldest first. */
  recent_events(): Promise<Answer<Page<StationEvent>>>;
  /** @param time RFC 3339, of the robot */
  events_since(time: string): Promise<Answer<Page<StationEvent>>>;
}
/** Failures in simulated time. */
export interface DrillCalls {
  /** The one that runs, or the last one. */
  read(): Promise<Answer<Drill>>;
  begin(wish: DrillWish): Promise<Answer<Drill>>;
  cancel(): Promise<Answer<Drill>>;
}
/** Of what is drawn and becomes a mission: a field, a block of rows. */
export interface PlanningCalls<Wish, Result> {
  /** Works it out; nothing is stored. */
  preview(wish: Wish): Promise<Answer<Result>>;
}
export type SurveyCalls = PlanningCalls<SurveyWish, Survey>;
export type RowsCalls = PlanningCalls<RowsWish, RowBlock>;
export interface FenceCalls {
  list(): Promise<Answer<Page<FenceSummary>>>;
  read(id: string): Promise<Answer<Fence>>;
  create(draft: FenceDraft): Promise<Answer<Fence>>;
  replace(id: string, revision: number, draft: FenceDraft): Promise<Answer<Fence>>;
  remove(id: string, revision: number): Promise<Answer<null>>;
  /** The fence that the robot keeps to. */
  active(): Promise<Answer<Fence | null>>;
  /** @param id null: none */
  activate(id: string | null): Promise<Answer<unknown>>;
}
/** The recording of a driven way. */
export interface TeachCalls {
  /** @return why nothing is recorded now; null: it is */
  waiting(): Promise<Answer<string | null>>;
  /** @param name of the mission; empty: the time */
  start(name: string): Promise<Answer<unknown>>;
  pause(): Promise<Answer<unknown>>;
  resume(): Promise<Answer<unknown>>;
  discard(): Promise<Answer<unknown>>;
  stop(): Promise<Answer<Mission>>;
}
/** What the open socket can do besides. */
export interface LiveLink extends SeenLink {
  readonly send_drive: SendDrive;
  readonly send_throttle: SendThrottle;
  /** @return false: not connected, nothing was sent */
  send_halt(halt: Halt): boolean;
  /** The robot's time at which the person saw what is shown now; null: nothing is. */
  seen_s(): number | null;
  /** What the robot's clock says now; null: no round trip tells. */
  robot_s(): number | null;
}

export interface StreamEvents extends SeenEvents {
  on_link(link: LinkHealth): void;
  on_hello(capabilities: Capabilities): void;
  /** @param mono_s the robot's clock when this was true */
  on_vehicle(vehicle: Vehicle, mono_s: number): void;
  /** A message of ours was refused, such as one of the sticks. */
  on_refused(refusal: Refusal): void;
  /** The robot has taken the stop that was sent over the socket. */
  on_stopped(): void;
  on_event(event: StationEvent): void;
  /** A stored mission changed; revision null: it was deleted. */
  on_mission_changed(id: string, revision: number | null): void;
  /** Who has control: at once, and with every change. */
  on_control?(control: ControlState): void;
}

/** What the page keeps on the device, so that a dead battery loses nothing. */
export interface DraftStorage {
  read(): string | null;
  /** @return false: no room or not allowed */
  write(text: string): boolean;
}

export interface RobotOnMap {
  readonly at: LatLon;
  readonly heading_deg: number | null;
  /** Of the heading, 1σ; null: not known. */
  readonly heading_accuracy_deg: number | null;
  readonly accuracy_m: number | null;
  readonly ellipse: Position['ellipse'];
  readonly stale: boolean;
  /** How old that is, in words, once it matters. */
  readonly old: string | null;
  /** How near to the fence it is, once it matters. */
  readonly fence: string | null;
}
/** The mission the robot has loaded. */
export interface RouteOnMap {
  /** Null hides it. */
  readonly plan: Plan | null;
  /** As it is laid out; empty: not known. */
  readonly way: readonly LatLon[];
  /** From 1; 0: none. */
  readonly current_item: number;
  /** So far to both sides the robot may come off it; null: not known. */
  readonly corridor_m: number | null;
}
/** A place on the map that means something, and how the robot faces there. */
export interface Mark extends LatLon {
  readonly heading_deg: number | null;
  /** The way there from the robot; left out: straight. */
  readonly line?: readonly LatLon[];
  /** Around it; clockwise null: no way, but the area in which the robot stays. */
  readonly ring?: { readonly radius_m: number; readonly clockwise: boolean | null };
}
export interface MapCalls extends SeenMap, SiteMapView, EditView {
  listen(events: MapEvents): void;
  set_mode(mode: MapMode): void;
  /** What is edited: a mission, a ring, or places that nothing joins. @param faint it is not what the
   * robot drives */
  show_plan(
    plan: Plan,
    selected: number | null,
    refused: ReadonlySet<number>,
    shape: PlanShape,
    faint: boolean,
  ): void;
  /** Where to stay and where not to go; null: nothing of the kind. */
  show_fence(fence: FenceDraft | null): void;
  show_route(route: RouteOnMap): void;
  show_robot(robot: RobotOnMap | null, tracks: Tracks): void;
  /** How it is to be driven; null: not shown. */
  show_drive(drive: DriveOnMap | null): void;
  /** The colours of the way so far; null: one. */
  show_trail(shades: TrailShades | null): void;
  show_home(home: LatLon | null): void;
  /** @param pin the place that the person chose; @param goal where the robot drives to; @param me where
   * this device is */
  show_marks(pin: Mark | null, goal: Mark | null, me: MeOnMap | null): void;
  /** Runs, or a survey that is being planned, instead of the way so far; none: that one again. */
  show_runs(runs: readonly RunOnMap[]): void;
  /** Several runs as one picture; null: none. */
  show_heat(heat: Heat | null): void;
  /** Where the ground gave way, and what the robot knows itself by. */
  show_places(kept: KeptPlaces): void;
  /** What a calibration drive needs; null: none is looked at. */
  show_space(space: SpaceOnMap | null): void;
  /** What a drill found; null: none is looked at. */
  show_drill(drill: DrillOnMap | null): void;
  /** Footprint of the vehicle, drawn to scale. */
  set_size(length_m: number, width_m: number): void;
  /** What panels cover, pixels: the robot, the edited item and fitted routes stay in the free
   * part. */
  set_cover(top: number, right: number, bottom: number, left: number): void;
  set_follow(follow: boolean): void;
  /** With the heading up the map turns while it follows the robot and is not drawn on.
   * @param turned hears by how much it is turned, clockwise */
  keep_up(up: MapUp, turned: (turn_deg: number) => void): void;
  /** Once, also where the map does not follow. */
  center_robot(): void;
  /** @param closely also where that is a metre across */
  fit(points: readonly LatLon[], closely?: boolean): void;
  zoom_by(levels: number): void;
  /** @param told hears whether no picture of it comes */
  use_ground(ground: Ground | null, told: (silent: boolean) => void): void;
  /** What it shows now; null: nothing yet. */
  view_bounds(): Bounds | null;
  /** Of the web's tiles. */
  zoom_level(): number;
}
