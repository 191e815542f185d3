// What the stream says, with its freshness. Time moves on here, so that silence shows.

import { fence_near } from '../model/fence';
import { age as age_text } from '../model/format';
import {
  link_age_s,
  link_stale,
  NO_LINK,
  OLD_AFTER_MS,
  round_trip_s,
  type LinkHealth,
} from '../model/freshness';
import type { Facts } from '../model/operations';
import type { LatLon } from '../model/plan';
import type { RobotOnMap } from '../model/ports';
import { say } from '../model/say';
import { sample_of, Telemetry } from '../model/telemetry';
import { Tracks } from '../model/tracks';
import { robot_place, type Capabilities, type Vehicle } from '../model/vehicle';
import { same_words } from '../model/words';

/** Figures that change faster cannot be read, and cost a phone half of its time: what is written is
 * renewed so often, and at once where more changes than a number. */
const SHOW_MS = 230;
/** Without messages. Later than with them, ten in a second, so that both make one picture. */
const CLOCK_MS = 360;
const STICK_REFUSED_MS = 1500;

export class Live {
  link = $state.raw<LinkHealth>(NO_LINK);
  vehicle = $state.raw<Vehicle | null>(null);
  capabilities = $state.raw<Capabilities | null>(null);
  now_ms = $state(performance.now());
  readonly tracks = new Tracks();
  readonly telemetry = new Telemetry();

  stale = $derived(link_stale(this.link, this.now_ms));
  age_s = $derived(link_age_s(this.link, this.now_ms));
  /** How old everything live is, once that matters: "2.3 s old". */
  old = $derived(
    !this.stale
      ? null
      : this.age_s === null
        ? say('age_not_known')
        : say('age_old', { age: age_text(this.age_s) }),
  );
  /** Messages come, but what they tell is old. */
  #late = $derived(
    this.link.socket === 'open' && this.now_ms - (this.link.last_message_ms ?? 0) <= OLD_AFTER_MS,
  );
  /** Why others' commands would be obeyed and this page's not; null: they are, or it is not known. */
  no_control = $state<string | null>(null);
  facts = $derived<Facts>({
    link_stale: this.stale,
    link_late: this.#late,
    vehicle: this.vehicle,
    no_control: this.no_control,
  });
  /** Why the stick that is held is not obeyed. */
  stick_refused = $state<string | null>(null);
  robot = $derived<RobotOnMap | null>(this.#robot(this.vehicle));

  #forgiven: ReturnType<typeof setTimeout> | undefined;
  /** What came last; it is shown with the next look at the clock. */
  #came: { vehicle: Vehicle | null; link: LinkHealth } = { vehicle: null, link: NO_LINK };
  #clock: ReturnType<typeof setTimeout> | undefined;

  constructor() {
    this.#show();
  }

  take_link(link: LinkHealth): void {
    this.#came.link = link;
    const now_ms = performance.now();
    const other =
      link.socket !== this.link.socket ||
      (this.stale && !link_stale(link, now_ms)) ||
      !this.vehicle;
    if (other || now_ms - this.now_ms >= SHOW_MS) this.#show();
  }

  /** @return null: what is written shows it already; else the robot, for the map */
  take(vehicle: Vehicle): RobotOnMap | null {
    this.#note(vehicle);
    this.#came.vehicle = vehicle;
    const early = performance.now() - this.now_ms < SHOW_MS;
    if (early && !this.stale && this.vehicle && same_words(this.vehicle, vehicle, ['time'])) {
      return this.#robot(vehicle);
    }
    this.#show();
    return null;
  }

  /** Time moves on without messages, too: and the moment when all is old is shown when it comes. */
  #show(): void {
    const { vehicle, link } = this.#came;
    this.now_ms = performance.now();
    this.link = link;
    this.vehicle = vehicle;
    const left_ms = (link.true_at_ms ?? -Infinity) + OLD_AFTER_MS - this.now_ms;
    clearTimeout(this.#clock);
    this.#clock = setTimeout(
      () => this.#show(),
      left_ms > 0 ? Math.min(CLOCK_MS, left_ms + 1) : CLOCK_MS,
    );
  }

  #note(vehicle: Vehicle): void {
    this.tracks.take(vehicle);
    const back_s = round_trip_s(this.link, performance.now());
    this.telemetry.take(Date.parse(vehicle.time) / 1000, sample_of(vehicle, back_s));
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

  #robot(vehicle: Vehicle | null): RobotOnMap | null {
    const at = robot_place(vehicle);
    if (!vehicle || !at) return null;
    const { position } = vehicle;
    return {
      at,
      heading_deg: position.heading_deg,
      heading_accuracy_deg: position.heading_accuracy_deg,
      accuracy_m: position.horizontal_accuracy_m,
      ellipse: position.ellipse,
      stale: position.stale || this.stale,
      old: this.old,
      fence: position.stale || this.stale ? null : fence_near(vehicle.fence),
    };
  }
}
