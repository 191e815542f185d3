// "Come to me": the phone's place, looked at as long as the card is open, and told to the robot as long as
// it shall come. What ends the telling ends the drive: the robot is told to stand, and brakes by itself
// after a second without a word.

import { refusal_text } from '../model/answer';
import { distance_m } from '../model/geo';
import {
  kept_m,
  me_on_map,
  my_target,
  newest,
  OLDEST_S,
  TELL_EVERY_MS,
  why_not_here,
  with_fix,
  type Fix,
  type Me,
  type MeCalls,
  type MeOnMap,
  type NoPlace,
} from '../model/me';
import { why_not_go } from '../model/modes';
import { no_link } from '../model/operations';
import { say } from '../model/say';
import { robot_place } from '../model/vehicle';
import type { Live } from './live.svelte';
import type { Pilot } from './pilot.svelte';

const FIRST_FIX_MS = 15_000;
const LOOK_EVERY_MS = 200;

export class MyPlace {
  /** Its card is. */
  open = $state(false);
  /** It is told where this phone is. */
  coming = $state(false);
  /** And was seen to follow. */
  seen_coming = $state(false);
  /** Why it does not come any more. */
  ended = $state<string | null>(null);
  gap_m = $state<number | null>(null);
  now_ms = $state(0);

  why_not = $derived.by<string | null>(() => why_not_here(this.#me, this.now_ms, this.#none));
  why_not_come = $derived.by<string | null>(() => why_not_go(this.#live.facts) ?? this.why_not);
  fix = $derived.by<Fix | null>(() => newest(this.#me));
  away_m = $derived.by<number | null>(() => {
    const robot = robot_place(this.#live.vehicle);
    return this.fix && robot ? distance_m(this.fix, robot) : null;
  });
  on_map = $derived.by<MeOnMap | null>(() => (this.open ? me_on_map(this.#me, this.now_ms) : null));

  readonly #calls: MeCalls;
  readonly #live: Live;
  readonly #pilot: Pilot;
  #me = $state.raw<Me>([]);
  #none = $state<NoPlace | null>(null);
  #telling = false;
  #before_m: number | null = null;
  #refused: string | null = null;
  #linked_ms = 0;
  #asking = false;
  #ends: (() => void)[] = [];

  constructor(calls: MeCalls, live: Live, pilot: Pilot) {
    this.#calls = calls;
    this.#live = live;
    this.#pilot = pilot;
  }

  toggle(): void {
    if (this.open) {
      this.close();
      return;
    }
    this.open = true;
    this.#look();
  }

  close(): void {
    if (this.coming || this.#asking) this.stand(say('me_closed'));
    this.#look_away();
    this.open = false;
    this.ended = null;
  }

  async come(): Promise<void> {
    this.ended = null;
    this.#asking = true;
    try {
      this.#before_m = null;
      if (!(await this.#tell())) {
        if (this.#asking) this.ended ??= this.why_not ?? say('me_waiting');
        return;
      }
      if (!this.#asking) return;
      if (!(await this.#pilot.set_mode('FOLLOW')) || !this.#asking) return;
      this.#linked_ms = this.#calls.now_ms();
      this.coming = true;
    } finally {
      this.#asking = false;
    }
  }

  /** Told to the robot at once; @param why is shown until it is asked to come again */
  stand(why: string | null): void {
    this.#asking = false;
    this.coming = this.seen_coming = false;
    this.ended = why;
    this.#pilot.hold();
  }

  /** The first good place; or why there is none. */
  async first(): Promise<Fix | string> {
    this.#look();
    const until_ms = this.#calls.now_ms() + FIRST_FIX_MS;
    try {
      for (;;) {
        this.now_ms = this.#calls.now_ms();
        if (this.why_not === null && this.fix) return this.fix;
        const for_good = this.#none !== null && this.#none !== 'unavailable';
        if (for_good || this.now_ms > until_ms) return this.why_not ?? say('me_waiting');
        await new Promise((done) => setTimeout(done, LOOK_EVERY_MS));
      }
    } finally {
      if (!this.open) this.#look_away();
    }
  }

  #look_away(): void {
    for (const end of this.#ends.splice(0)) end();
  }

  #look(): void {
    if (this.#ends.length > 0) return;
    this.#me = [];
    this.#none = this.#calls.impossible;
    this.now_ms = this.#calls.now_ms();
    const timer = setInterval(() => this.#tick(), TELL_EVERY_MS);
    this.#ends = [
      () => clearInterval(timer),
      this.#calls.watch(
        (fix) => {
          this.#none = null;
          this.#me = with_fix(this.#me, fix);
        },
        (why) => (this.#none = why),
      ),
      this.#calls.on_hidden(() => {
        if (this.coming || this.#asking) this.stand(say('me_hidden'));
      }),
    ];
    void this.#calls.gap_m().then((gap_m) => (this.gap_m = gap_m));
  }

  #tick(): void {
    this.now_ms = this.#calls.now_ms();
    if (!this.coming) return;
    const { facts, vehicle } = this.#live;
    const unlinked = no_link(facts);
    if (unlinked === null) this.#linked_ms = this.now_ms;
    // The robot brakes by itself meanwhile, and goes on: a gap of a weak network ends nothing.
    const gone = this.now_ms - this.#linked_ms > OLDEST_S * 1000 ? unlinked : null;
    const lost = gone ?? facts.no_control ?? this.why_not;
    if (lost !== null) {
      this.stand(lost);
      return;
    }
    const follows = vehicle?.mode === 'FOLLOW';
    if (unlinked === null && this.seen_coming && !follows) {
      // Somebody, or the robot itself, chose otherwise: nothing is to be stopped.
      const reason = vehicle?.activity.reason ?? '';
      this.coming = this.seen_coming = false;
      this.ended = this.#refused ?? (reason === '' ? null : reason);
      return;
    }
    this.seen_coming = this.seen_coming || follows;
    void this.#tell();
  }

  /** @return it was taken */
  async #tell(): Promise<boolean> {
    if (this.#telling) return false;
    const before_m = kept_m(this.#me, this.#before_m);
    const robot = robot_place(this.#live.vehicle);
    const target = my_target(this.#me, robot, this.#calls.now_ms(), before_m);
    if (!target) return false;
    this.#telling = true;
    const answer = await this.#calls.tell(target);
    this.#telling = false;
    this.#before_m = before_m;
    // Not taken, or not heard: the next one may be, and else the robot stands by itself.
    this.#refused = answer.ok ? null : refusal_text(answer.refusal);
    if (this.#asking) this.ended = this.#refused;
    return answer.ok;
  }
}
