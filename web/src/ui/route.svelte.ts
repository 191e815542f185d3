// The mission that the robot has loaded, for the map: its items, and the way as it is laid out.

import { refusal_text } from '../model/answer';
import type { WayPace, WayStop } from '../model/laid_way';
import type { LatLon, Plan } from '../model/plan';
import type { MissionCalls, VehicleCalls } from '../model/ports';
import { begin_heading, NO_SPEEDS, type SpeedsSet } from '../model/route_drive';
import { say } from '../model/say';
import { plan_of } from '../model/stored_plan';
import type { Vehicle } from '../model/vehicle';
import type { Notices } from './notices.svelte';

interface LaidWay {
  readonly line: readonly LatLon[];
  readonly pace: readonly WayPace[];
  readonly stops: readonly WayStop[];
}
const NO_WAY: LaidWay = { line: [], pace: [], stops: [] };

export class LoadedRoute {
  plan = $state.raw<Plan | null>(null);
  /** Corners rounded, dense points smoothed; empty: not known. */
  #laid_way = $state.raw<LaidWay>(NO_WAY);
  way = $derived(this.#laid_way.line);
  /** How it is driven, as the robot plans it. */
  pace = $derived(this.#laid_way.pace);
  stops = $derived(this.#laid_way.stops);
  /** How the robot points where its way begins, before it starts; null: it stands elsewhere. */
  begin_deg = $state<number | null>(null);

  /** What bounds its speeds, and the one where it says none. */
  speeds_set = $state.raw<SpeedsSet>(NO_SPEEDS);

  corridor_m = $state<number | null>(null);
  laid = $derived({ plan: this.plan, way: this.way, corridor_m: this.corridor_m });

  readonly #missions: MissionCalls;
  readonly #vehicle: VehicleCalls;
  readonly #notices: Notices;
  #plan_key = '';
  #way_key = '';
  /** Running, paused or blocked: it keeps the way and the default that it was laid out by. */
  #in_hand = false;

  constructor(missions: MissionCalls, vehicle: VehicleCalls, notices: Notices) {
    this.#missions = missions;
    this.#vehicle = vehicle;
    this.#notices = notices;
  }

  /** A state of the robot came. @return whether another mission or revision is loaded now */
  take({ mission, position }: Vehicle): boolean {
    const { id, revision, state } = mission;
    this.corridor_m = mission.cross_track_limit_m;
    const key = id === null || revision === null ? '' : `${id} ${revision}`;
    const other = key !== this.#plan_key;
    this.#plan_key = key;
    if (other) void this.#read_plan(key, id, revision);
    // As long as it is not in hand, parameters may lay it anew: asked for with every change of state.
    this.#in_hand = state === 'running' || state === 'paused' || state === 'blocked';
    const way_key = key && `${key} ${state}`;
    if (way_key !== this.#way_key) {
      void this.#read_way(way_key);
      if (way_key) void this.read_speeds(other);
    }
    const { lat, lon, heading_deg } = position;
    const at =
      state === 'loaded' && lat !== null && lon !== null ? { lat, lon, heading_deg } : null;
    this.begin_deg = begin_heading(this.#laid_way.stops, at);
    return other;
  }

  /** @param other another mission is loaded now */
  async read_speeds(other = false): Promise<void> {
    const known_mps = other || !this.#in_hand ? null : this.speeds_set.default_mps;
    const read = await this.#vehicle.speeds_set();
    this.speeds_set = known_mps === null ? read : { ...read, default_mps: known_mps };
  }

  /** The robot drives its own copy of one revision: fetch exactly that one. */
  async #read_plan(key: string, id: string | null, revision: number | null): Promise<void> {
    if (id === null || revision === null) {
      this.plan = null;
      return;
    }
    const answer = await this.#missions.read_revision(id, revision);
    if (this.#plan_key !== key) return;
    this.plan = answer.ok ? plan_of(answer.value) : null;
    if (!answer.ok) {
      this.#notices.show(
        'warning',
        say('the_route_cannot_be_shown_refusal', { refusal: refusal_text(answer.refusal) }),
      );
    }
  }

  async #read_way(key: string): Promise<void> {
    this.#way_key = key;
    if (key === '') {
      this.#laid_way = NO_WAY;
      return;
    }
    const answer = await this.#vehicle.mission_way();
    if (this.#way_key !== key) return;
    const same =
      answer.ok && key.startsWith(`${answer.value.mission_id} ${answer.value.revision} `);
    this.#laid_way = same ? answer.value : NO_WAY;
  }
}
