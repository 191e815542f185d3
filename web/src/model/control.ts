// Who has control: one drives, everyone may watch, anyone may stop.

import type { Answer } from './answer';
import { role_words, type Role } from './people';
import { say } from './say';

export interface Driver {
  readonly id: string;
  readonly user: string;
  readonly name: string;
  readonly kind: 'browser' | 'script';
}

export interface ControlHolder extends Driver {
  /** Lost then, if nothing is heard; null: it is heard. */
  readonly grace_left_s?: number | null;
}

export interface ControlRequest extends Driver {
  readonly request: number;
  readonly expires_in_s: number;
}

export interface Present extends Driver {
  readonly role: Role;
  /** Tabs of a browser, connections of a script. */
  readonly streams: number;
}

export interface ControlState {
  readonly on: boolean;
  readonly holder: ControlHolder | null;
  readonly requests: readonly ControlRequest[];
  /** Who is connected; left out where only a change is told. */
  readonly here?: readonly Present[];
  readonly change?: {
    readonly what: string;
    readonly detail: string;
    readonly from: Driver | null;
    readonly to: Driver | null;
  };
}

export type TakeWish = { readonly ask?: true } | { readonly force: true; readonly reason: string };

export interface ControlCalls {
  state: () => Promise<Answer<ControlState>>;
  take: (wish: TakeWish) => Promise<Answer<ControlState>>;
  release: () => Promise<Answer<ControlState>>;
  hand_over: (request: number, accept: boolean) => Promise<Answer<ControlState>>;
}

export const LONGEST_REASON = 200;

/** What this browser is to the one who has control. */
export type Seat = 'free' | 'mine' | 'asked' | 'others';

const is = (driver: Driver | null, me: string): boolean =>
  driver !== null && driver.kind === 'browser' && driver.id === me;

/** @param me the id of this browser's session */
export const seat_of = (state: ControlState, me: string): Seat => {
  if (state.holder === null) return 'free';
  if (is(state.holder, me)) return 'mine';
  return state.requests.some((one) => is(one, me)) ? 'asked' : 'others';
};

export const driver_name = ({ user, name, kind }: Driver): string =>
  `${user} (${kind === 'script' ? say('script_name', { name }) : device_name(name)})`;

const MACHINES = ['iPhone', 'iPad', 'Android', 'Windows', 'Macintosh', 'CrOS', 'Linux'];

/** A browser calls itself a long name, of which a person wants to know the machine. */
export const device_name = (device: string): string => {
  const machine = MACHINES.find((word) => device.includes(word));
  return machine !== undefined && device.startsWith('Mozilla/') ? machine : device;
};

const LONG_NAME = '(Mozilla/';

/** Where the robot names a browser in a sentence, as that calls itself: "anna (Android)". */
export const plain_devices = (text: string): string => {
  const begin = text.indexOf(LONG_NAME);
  if (begin < 0) return text;
  let depth = 0;
  let end = begin;
  do {
    const letter = text[end];
    if (letter === '(') depth += 1;
    if (letter === ')') depth -= 1;
    end += 1;
  } while (depth > 0 && end < text.length);
  const device = device_name(text.slice(begin + 1, depth > 0 ? end : end - 1));
  return `${text.slice(0, begin)}(${device})${plain_devices(text.slice(end))}`;
};

/** "anna (Android), drives": the one who has control first, then by name. @param me as above */
export const present_lines = (
  state: ControlState,
  me: string,
): { key: string; words: string }[] => {
  const has = ({ id, kind }: Present): boolean =>
    state.holder?.id === id && state.holder.kind === kind;
  return [...(state.here ?? [])]
    .sort((a, b) => Number(has(b)) - Number(has(a)) || a.user.localeCompare(b.user))
    .map((one, k) => {
      const parts = [
        driver_name(one),
        role_words[one.role],
        ...(has(one) ? [say('has_control')] : []),
        ...(is(one, me) ? [say('that_is_you')] : []),
      ];
      return { key: `${k} ${one.id}`, words: parts.join(', ') };
    });
};

/** One line for the header. */
export const seat_words = (state: ControlState, me: string): string => {
  switch (seat_of(state, me)) {
    case 'free':
      return say('nobody_has_control');
    case 'mine':
      return say('you_have_control');
    case 'asked':
    case 'others':
      return state.holder ? say('holder_has_control', { holder: driver_name(state.holder) }) : '';
  }
};

/** Why what acts on the robot is refused. @param drives is allowed to have control at all */
export const why_no_control = (seat: Seat, drives: boolean, state: ControlState): string | null => {
  if (seat === 'mine') return null;
  if (!drives) return say('you_watch_and_may_stop');
  if (state.holder === null) return say('take_control_first');
  return say('holder_has_control_ask', { holder: driver_name(state.holder) });
};

/** What this person must hear of a change; empty: nothing. */
export const told_of = (state: ControlState, me: string): string => {
  const { change } = state;
  if (!change) return '';
  const { what, from, to, detail } = change;
  const for_holder = is(from, me) && ['forced', 'lost', 'ended'].includes(what);
  const for_asker =
    is(to, me) && ['refused', 'expired', 'handed_over'].includes(what) && !is(from, me);
  return for_holder || for_asker ? plain_devices(detail) : '';
};
