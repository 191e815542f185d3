// What stops or slows the robot. It never waits behind another command, and it is repeated until the
// robot has confirmed it: by its answer, or by its state in a message that is younger than the press.
//
//   pressed --sent over the socket and as a request--> trying --(next try)--> trying
//   trying  --answer | state that is young enough--> confirmed
//   trying  --the robot says that there is nothing to halt--> refused

import { robot_says } from './robot_words';
import { fixed } from './figures';
import { language_now, say, told } from './say';
import type { Vehicle } from './vehicle';

export type Halt = 'estop' | 'hold' | 'pause' | 'disarm' | 'stop';

export const halt_words: Record<Halt, string> = told({
  estop: 'stop_caps',
  hold: 'hold_caps',
  pause: 'pause',
  disarm: 'disarm',
  stop: 'stop_mission',
});

export interface HaltTry {
  readonly halt: Halt;
  readonly state: 'trying' | 'confirmed' | 'refused';
  /** From 1. */
  readonly tries: number;
  readonly pressed_ms: number;
  readonly tried_ms: number;
  /** When it was confirmed or refused. */
  readonly ended_ms: number | null;
  /** The robot's clock from which on its state counts; null: not known, only an answer counts. */
  readonly from_mono_s: number | null;
  /** Why refused. */
  readonly detail: string;
}

/** Whether the robot is as the halt wants it. */
export const halted = (halt: Halt, vehicle: Vehicle): boolean => {
  const { state } = vehicle.mission;
  switch (halt) {
    case 'estop':
      return vehicle.estop;
    case 'hold':
      return vehicle.mode === 'HOLD';
    case 'pause':
      return state !== 'running';
    case 'disarm':
      return !vehicle.armed;
    case 'stop':
      return state !== 'running' && state !== 'paused' && state !== 'blocked';
  }
};

/**
 * @param robot_s the robot's clock at the press; null: not known
 * @param risk_until_s until then a command that moves and was sent before may still be obeyed; null:
 *   there is none
 */
export const begin_halt = (
  halt: Halt,
  now_ms: number,
  robot_s: number | null,
  risk_until_s: number | null,
): HaltTry => ({
  halt,
  state: 'trying',
  tries: 1,
  pressed_ms: now_ms,
  tried_ms: now_ms,
  ended_ms: null,
  from_mono_s: robot_s === null ? null : Math.max(robot_s, risk_until_s ?? robot_s),
  detail: '',
});

/** Quick at first, then once a second or once a round trip: copies must not fill a thin link. */
const PAUSES_MS = [300, 600, 1000];

export const next_try_ms = (at: HaltTry, round_trip_s: number): number => {
  const usual_ms = PAUSES_MS[Math.min(at.tries, PAUSES_MS.length) - 1] ?? 1000;
  const thin_ms = at.tries < 3 ? 0 : 1000 * round_trip_s;
  return at.tried_ms + Math.max(usual_ms, Math.min(thin_ms, 4000));
};

export const tried_again = (at: HaltTry, now_ms: number): HaltTry =>
  at.state === 'trying' ? { ...at, tries: at.tries + 1, tried_ms: now_ms } : at;

/** A state of the robot came. @param mono_s the robot's clock when it was true */
export const with_state = (
  at: HaltTry,
  vehicle: Vehicle,
  mono_s: number,
  now_ms: number,
): HaltTry =>
  at.state === 'trying' &&
  at.from_mono_s !== null &&
  mono_s >= at.from_mono_s &&
  halted(at.halt, vehicle)
    ? { ...at, state: 'confirmed', ended_ms: now_ms }
    : at;

/**
 * A request was answered. While a command that was sent before may still arrive, an answer is not
 * the end; and only the robot itself can say that there is nothing to halt: a full queue, a lost
 * connection and a login that ran out cannot.
 * @param settled no such command is on its way
 */
export const with_answer = (
  at: HaltTry,
  status: number,
  detail: string,
  settled: boolean,
  now_ms: number,
): HaltTry => {
  if (at.state !== 'trying' || !settled) return at;
  if (status >= 200 && status < 300) return { ...at, state: 'confirmed', ended_ms: now_ms };
  const refused = at.halt !== 'estop' && status === 409;
  return refused ? { ...at, state: 'refused', ended_ms: now_ms, detail } : at;
};

/** From then on a person is told what else stops the robot. */
export const HELP_AFTER_MS = 4000;
/** A halt that is confirmed sooner needs no words: the robot's state shows it. */
const WORDS_AFTER_MS = 300;
const SHOWN_MS = 4000;

const ordinal = (n: number): string => {
  if (language_now() !== 'en') return `${n}.`;
  const tens = n % 100;
  const ending = tens > 10 && tens < 14 ? 'th' : (['th', 'st', 'nd', 'rd'][n % 10] ?? 'th');
  return `${n}${ending}`;
};

export interface HaltLine {
  readonly tone: 'bad' | 'good' | 'warn';
  readonly head: string;
  readonly detail: string;
}

/** What is said about it; null: nothing (any more). */
export const halt_line = (at: HaltTry, now_ms: number): HaltLine | null => {
  const name = halt_words[at.halt];
  const took = fixed(((at.ended_ms ?? now_ms) - at.pressed_ms) / 1000, 1);
  const slow = (at.ended_ms ?? now_ms) - at.pressed_ms >= WORDS_AFTER_MS;
  if (at.state === 'trying') {
    const help =
      now_ms - at.pressed_ms < HELP_AFTER_MS ? '' : say('use_the_button_on_the_robot_or_the');
    const detail = say('try_ordinal', {
      tries: ordinal(at.tries),
      took,
      help,
    });
    return slow ? { tone: 'bad', head: say('name_stopping', { name }), detail } : null;
  }
  if (over(at, now_ms)) return null;
  if (at.state === 'refused')
    return { tone: 'warn', head: `${name}:`, detail: robot_says(at.detail) };
  const detail = say('by_the_robot_took_s_after_the_press', { took });
  return slow ? { tone: 'good', head: say('name_confirmed', { name }), detail } : null;
};

/** Nothing of it is left to say. */
export const over = (at: HaltTry, now_ms: number): boolean =>
  at.ended_ms !== null && now_ms - at.ended_ms > SHOWN_MS;
