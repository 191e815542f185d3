// Both tracks of the map: where the robot believes it drove, and what its receiver said. The stream
// brings them point by point; what was before comes from the server's memory:
//
//   server's memory  ────────────────┤ its time
//   live points              ·  ·  · │ ·  ·  ·  ·▶     those behind that time are added again

import type { LatLon } from './plan';
import { Trail, type Driven, type TrailPiece } from './trail';
import { receiver_place, robot_place, type Vehicle } from './vehicle';

/** The way so far, as the server remembers it. */
export interface Remembered {
  /** Unix time up to which it goes. */
  readonly until_s: number;
  readonly estimated: readonly TrailPiece[];
  readonly received: readonly TrailPiece[];
}

interface Sample {
  readonly t_s: number;
  readonly reach_m: number;
  readonly at: LatLon | null;
  readonly received: LatLon | null;
  readonly driven: Driven;
}

/** Only a running mission has a way to be off: a robot that is driven by hand beside it is not. */
const driven_of = ({ position, mission }: Vehicle): Driven => ({
  speed_mps: Math.abs(position.speed_mps ?? Number.NaN),
  off_m: mission.state === 'running' ? Math.abs(mission.cross_track_m ?? Number.NaN) : Number.NaN,
});

/** The server's rule for a jump: a way that the robot's own speed does not explain. */
const reach_of = (speed_mps: number | null): number => 2 + 2 * Math.abs(speed_mps ?? 0);
const RECEIVER_REACH_M = 10;

/** A minute at ten a second; an answer never takes so long. */
const SAMPLES = 600;

export class Tracks {
  readonly driven = new Trail();
  readonly fixes = new Trail();
  /** The newest live samples. */
  readonly #samples: Sample[] = [];

  /** Live points would soon push out what is drawn; the server's memory is thinned with more care. */
  get full(): boolean {
    return this.driven.full || this.fixes.full;
  }

  take(vehicle: Vehicle): void {
    const sample = {
      t_s: Date.parse(vehicle.time) / 1000,
      reach_m: reach_of(vehicle.position.speed_mps),
      at: vehicle.position.stale ? null : robot_place(vehicle),
      received: receiver_place(vehicle),
      driven: driven_of(vehicle),
    };
    this.#samples.push(sample);
    if (this.#samples.length > SAMPLES) this.#samples.shift();
    this.#add(sample);
  }

  restore(remembered: Remembered): void {
    this.driven.restore(remembered.estimated, remembered.until_s);
    this.fixes.restore(remembered.received, remembered.until_s);
    for (const sample of this.#samples) if (sample.t_s > remembered.until_s) this.#add(sample);
  }

  places(): LatLon[] {
    return [...this.driven.points(), ...this.fixes.points()];
  }

  #add({ t_s, reach_m, at, received, driven }: Sample): void {
    if (at) this.driven.add(at, t_s, reach_m, driven);
    if (received) this.fixes.add(received, t_s, RECEIVER_REACH_M);
  }
}
