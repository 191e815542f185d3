// What stops or slows the robot: sent the moment it is pressed, over the open socket and as a request
// of its own, and again until the robot has confirmed it.

import {
  begin_halt,
  next_try_ms,
  over,
  tried_again,
  with_answer,
  with_state,
  type Halt,
  type HaltTry,
} from '../model/halt';
import { round_trip_s } from '../model/freshness';
import type { LiveLink, VehicleCalls } from '../model/ports';
import type { Vehicle } from '../model/vehicle';
import type { Live } from './live.svelte';

const TICK_MS = 50;
/** Requests of one halt that wait for an answer. A third makes the oldest give up its connection:
 * a new one may get through where an old one is dead. */
const MOST_UNDER_WAY = 2;

export class Halts {
  /** The latest press of each kind. */
  tries = $state.raw<readonly HaltTry[]>([]);
  /** Until then, on the robot's clock, a command that moves may still be obeyed. */
  risk_until_s: number | null = null;

  readonly #calls: VehicleCalls;
  readonly #link: LiveLink;
  readonly #live: Live;
  readonly #under_way = new Map<Halt, AbortController[]>();

  constructor(calls: VehicleCalls, link: LiveLink, live: Live) {
    this.#calls = calls;
    this.#link = link;
    this.#live = live;
    setInterval(() => this.#tick(), TICK_MS);
  }

  trying(halt: Halt): boolean {
    return this.tries.some((each) => each.halt === halt && each.state === 'trying');
  }

  /** Every press sends at once; one series of tries goes on until it is confirmed. */
  press(halt: Halt): void {
    this.#link.send_drive(0, 0, false);
    const now_ms = performance.now();
    const begun = this.tries.find((each) => each.halt === halt && each.state === 'trying');
    const next = begun
      ? tried_again(begun, now_ms)
      : begin_halt(halt, now_ms, this.#link.robot_s(), this.risk_until_s);
    this.#put(next);
    this.#send(halt);
  }

  /** The person gives up: nothing more is sent. */
  give_up(halt: Halt): void {
    this.tries = this.tries.filter((each) => each.halt !== halt);
    this.#hang_up(halt);
  }

  on_vehicle(vehicle: Vehicle, mono_s: number): void {
    const now_ms = performance.now();
    for (const each of this.tries) this.#become(each, with_state(each, vehicle, mono_s, now_ms));
  }

  /** The robot said on the socket that it has taken the stop. */
  on_stopped(): void {
    this.#answered('estop', 200, '');
  }

  #tick(): void {
    if (this.tries.length === 0) return;
    const now_ms = performance.now();
    const back_s = round_trip_s(this.#live.link, now_ms) ?? 0;
    for (const each of this.tries) {
      if (over(each, now_ms)) this.tries = this.tries.filter((other) => other !== each);
      if (each.state !== 'trying' || now_ms < next_try_ms(each, back_s)) continue;
      this.#put(tried_again(each, now_ms));
      this.#send(each.halt);
    }
  }

  #send(halt: Halt): void {
    this.#link.send_halt(halt);
    const under_way = this.#under_way.get(halt) ?? [];
    while (under_way.length >= MOST_UNDER_WAY) under_way.shift()?.abort();
    const hang_up = new AbortController();
    this.#under_way.set(halt, [...under_way, hang_up]);
    void this.#calls.halt(halt, hang_up.signal).then((answer) => {
      const rest = (this.#under_way.get(halt) ?? []).filter((each) => each !== hang_up);
      this.#under_way.set(halt, rest);
      if (answer.ok) this.#answered(halt, 200, '');
      else this.#answered(halt, answer.refusal.status, answer.refusal.detail);
    });
  }

  #answered(halt: Halt, status: number, detail: string): void {
    const at = this.tries.find((each) => each.halt === halt);
    if (!at) return;
    const now_s = this.#link.robot_s();
    const settled =
      this.risk_until_s === null || (now_s !== null && now_s >= (at.from_mono_s ?? now_s));
    this.#become(at, with_answer(at, status, detail, settled, performance.now()));
  }

  #become(from: HaltTry, to: HaltTry): void {
    if (from === to) return;
    this.#put(to);
    if (to.state !== 'trying') this.#hang_up(to.halt);
  }

  #hang_up(halt: Halt): void {
    for (const each of this.#under_way.get(halt) ?? []) each.abort();
    this.#under_way.delete(halt);
  }

  #put(next: HaltTry): void {
    this.tries = [...this.tries.filter(({ halt }) => halt !== next.halt), next];
  }
}
