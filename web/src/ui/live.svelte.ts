// What the stream says, with its freshness. Time moves on here, so that silence shows.

import { add_sample, empty_columns, type Columns } from '../model/columns';
import { age as age_text } from '../model/format';
import { link_age_s, link_stale, NO_LINK, OLD_AFTER_MS, type LinkHealth } from '../model/freshness';
import type { Facts } from '../model/operations';
import type { LatLon } from '../model/plan';
import type { RobotOnMap } from '../model/ports';
import { Tracks } from '../model/tracks';
import { robot_place, type Capabilities, type Vehicle } from '../model/vehicle';

const CLOCK_MS = 200;
const STICK_REFUSED_MS = 1500;
/** Two minutes at ten a second. */
const CHART_SAMPLES = 1200;

export class Live {
  link = $state.raw<LinkHealth>(NO_LINK);
  vehicle = $state.raw<Vehicle | null>(null);
  capabilities = $state.raw<Capabilities | null>(null);
  now_ms = $state(performance.now());
  readonly tracks = new Tracks();
  readonly chart: Columns = empty_columns(2);

  stale = $derived(link_stale(this.link, this.now_ms));
  age_s = $derived(link_age_s(this.link, this.now_ms));
  /** How old everything live is, once that matters: "2.3 s old". */
  old = $derived(
    !this.stale ? null : this.age_s === null ? 'age not known' : `${age_text(this.age_s)} old`,
  );
  facts = $derived<Facts>({
    link_stale: this.stale,
    // Messages come, but what they tell is old.
    link_late:
      this.link.socket === 'open' && this.now_ms - (this.link.last_message_ms ?? 0) <= OLD_AFTER_MS,
    vehicle: this.vehicle,
  });
  /** Why the stick that is held is not obeyed. */
  stick_refused = $state<string | null>(null);
  robot = $derived<RobotOnMap | null>(this.#robot());

  #forgiven: ReturnType<typeof setTimeout> | undefined;

  constructor() {
    setInterval(() => {
      this.now_ms = performance.now();
    }, CLOCK_MS);
  }

  take(vehicle: Vehicle): void {
    this.vehicle = vehicle;
    this.tracks.take(vehicle);
    const { speed_mps } = vehicle.position;
    const seconds = Date.parse(vehicle.time) / 1000;
    add_sample(this.chart, CHART_SAMPLES, seconds, [speed_mps, vehicle.mission.cross_track_m]);
  }

  /** The robot refused a message of ours; while a stick is held, one of its own. */
  refuse_stick(why: string): void {
    this.stick_refused = why;
    clearTimeout(this.#forgiven);
    this.#forgiven = setTimeout(() => (this.stick_refused = null), STICK_REFUSED_MS);
  }

  /** Everything worth seeing of the way so far. */
  get places(): readonly LatLon[] {
    return this.robot ? [...this.tracks.places(), this.robot.at] : this.tracks.places();
  }

  #robot(): RobotOnMap | null {
    const at = robot_place(this.vehicle);
    if (!this.vehicle || !at) return null;
    const { position } = this.vehicle;
    return {
      at,
      heading_deg: position.heading_deg,
      heading_accuracy_deg: position.heading_accuracy_deg,
      accuracy_m: position.horizontal_accuracy_m,
      ellipse: position.ellipse,
      stale: position.stale || this.stale,
      old: this.old,
    };
  }
}
