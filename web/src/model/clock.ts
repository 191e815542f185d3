// The robot's monotonic clock, as far as the page can know it. A round trip on the live socket says
// that the robot read its clock at some moment between sending and hearing back; half way is the
// best guess, and the shortest round trip of the last minute the best of the guesses:
//
//   page    sent ─────────────┬───────────── back      guess: robot = page + offset,
//   robot        ╲         mono_s         ╱             off by half the round trip at most
//
// So a message that was long on its way shows its age at once, also where the delay is new. Time is
// an argument: milliseconds of the page's own monotonic clock.

interface Guess {
  readonly offset_s: number;
  readonly round_trip_s: number;
  readonly at_ms: number;
}

/** Two good quartz clocks part by a few milliseconds in this time. */
const KEPT_MS = 60_000;
/** Beyond this a contradiction is a clock that stood still: the device slept, the robot restarted. */
const DRIFT_S = 0.05;

/** What the offset may be by a guess: half its round trip to both sides. */
const lowest_s = ({ offset_s, round_trip_s }: Guess): number => offset_s - round_trip_s / 2;
const highest_s = ({ offset_s, round_trip_s }: Guess): number => offset_s + round_trip_s / 2;

export class RobotClock {
  #guesses: Guess[] = [];

  /** @param mono_s what the robot's clock said in between */
  take_round_trip(sent_ms: number, back_ms: number, mono_s: number): void {
    const least_s = mono_s - back_ms / 1000;
    const most_s = mono_s - sent_ms / 1000;
    const now = this.#best();
    if (now && (highest_s(now) < least_s - DRIFT_S || lowest_s(now) > most_s + DRIFT_S))
      this.forget();
    const guess = {
      offset_s: (least_s + most_s) / 2,
      round_trip_s: (back_ms - sent_ms) / 1000,
      at_ms: back_ms,
    };
    this.#guesses = [...this.#guesses.filter(({ at_ms }) => back_ms - at_ms <= KEPT_MS), guess];
  }

  /** Any message: it cannot come from the future. */
  take_message(mono_s: number, at_ms: number): void {
    const now = this.#best();
    if (now && mono_s - at_ms / 1000 > highest_s(now) + DRIFT_S) this.forget();
  }

  /** When on the page's clock the robot's said this; null while no round trip tells. */
  page_ms(mono_s: number): number | null {
    const now = this.#best();
    return now ? (mono_s - now.offset_s) * 1000 : null;
  }

  /** What the robot's clock says now. */
  robot_s(at_ms: number): number | null {
    const now = this.#best();
    return now ? at_ms / 1000 + now.offset_s : null;
  }

  forget(): void {
    this.#guesses = [];
  }

  #best(): Guess | null {
    let best: Guess | null = null;
    for (const guess of this.#guesses) {
      if (!best || guess.round_trip_s <= best.round_trip_s) best = guess;
    }
    return best;
  }
}

/** Pings under way: at most this many, so that a dead link costs nothing. */
const MOST_UNANSWERED = 32;

/** Round trips on one socket. */
export class Pings {
  readonly #sent = new Map<number, number>();
  #next = 1;
  round_trip_s: number | null = null;

  /** @return the number to send; null: enough are under way */
  send(at_ms: number): number | null {
    if (this.#sent.size >= MOST_UNANSWERED) return null;
    const ping = this.#next;
    this.#next += 1;
    this.#sent.set(ping, at_ms);
    return ping;
  }

  /** Answers come in order: those before were lost with their socket. @return when it was sent */
  answer(ping: number, at_ms: number): number | null {
    const sent_ms = this.#sent.get(ping);
    if (sent_ms === undefined) return null;
    for (const each of [...this.#sent.keys()]) if (each <= ping) this.#sent.delete(each);
    this.round_trip_s = (at_ms - sent_ms) / 1000;
    return sent_ms;
  }

  /** When the oldest that has no answer yet was sent. */
  get unanswered_since_ms(): number | null {
    return this.#sent.values().next().value ?? null;
  }

  /** A new socket. */
  restart(): void {
    this.#sent.clear();
    this.round_trip_s = null;
  }
}
