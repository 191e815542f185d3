// The mission that the robot has loaded, for the map: its items, and the way as it is laid out.

import { refusal_text } from '../model/answer';
import type { LatLon, Plan } from '../model/plan';
import type { MissionCalls, VehicleCalls } from '../model/ports';
import type { Vehicle } from '../model/vehicle';
import { plan_of } from './editor.svelte';
import type { Notices } from './notices.svelte';

export class LoadedRoute {
  plan = $state.raw<Plan | null>(null);
  /** Corners rounded, dense points smoothed; empty: not known. */
  way = $state.raw<readonly LatLon[]>([]);

  readonly #missions: MissionCalls;
  readonly #vehicle: VehicleCalls;
  readonly #notices: Notices;
  #plan_key = '';
  #way_key = '';

  constructor(missions: MissionCalls, vehicle: VehicleCalls, notices: Notices) {
    this.#missions = missions;
    this.#vehicle = vehicle;
    this.#notices = notices;
  }

  /** A state of the robot came. @return whether another mission or revision is loaded now */
  take({ mission }: Vehicle): boolean {
    const { id, revision, state } = mission;
    const key = id === null || revision === null ? '' : `${id} ${revision}`;
    const other = key !== this.#plan_key;
    this.#plan_key = key;
    if (other) void this.#read_plan(key, id, revision);
    // As long as it is not in hand, parameters may lay it anew: asked for with every change of state.
    const way_key = key && `${key} ${state}`;
    if (way_key !== this.#way_key) void this.#read_way(way_key);
    return other;
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
      this.#notices.show('warning', `The route cannot be shown: ${refusal_text(answer.refusal)}`);
    }
  }

  async #read_way(key: string): Promise<void> {
    this.#way_key = key;
    if (key === '') {
      this.way = [];
      return;
    }
    const answer = await this.#vehicle.mission_way();
    if (this.#way_key !== key) return;
    const same =
      answer.ok && key.startsWith(`${answer.value.mission_id} ${answer.value.revision} `);
    this.way = same ? answer.value.line : [];
  }
}
