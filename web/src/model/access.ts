// Who is at this page, where the robot wants to know: log-in, first set-up, my devices.

import type { Answer } from './answer';

/** Of a password, in bytes. */
export const SHORTEST_PASSWORD = 12;

/** As what this browser is paired: a PIN opens it. */
export interface Paired {
  readonly id: string;
  readonly user: string;
  readonly name: string;
  /** Too many wrong PINs: it wants the password. */
  readonly locked: boolean;
}

export interface LogInState {
  /** False: nobody has to log in. */
  readonly access: boolean;
  /** There is no user yet: the first admin is made with the code that roverd printed. */
  readonly setup: boolean;
  readonly user: string | null;
  readonly role: string | null;
  /** Of the session. */
  readonly id: string | null;
  readonly paired: Paired | null;
}

export interface Device {
  readonly id: string;
  readonly device: string;
  readonly address: string;
  readonly seen: string | null;
  readonly current: boolean;
}

export interface PairedDevice {
  readonly id: string;
  readonly name: string;
  readonly role: string;
  readonly locked: boolean;
  readonly used: string | null;
  readonly current: boolean;
}

/** What another phone needs to be paired. */
export interface Invitation {
  readonly code: string;
  readonly role: string;
  readonly expires_in_s: number;
  readonly address: string | null;
  readonly svg: string | null;
}

export interface AccessCalls {
  state: () => Promise<Answer<LogInState>>;
  log_in: (user: string, password: string) => Promise<Answer<LogInState>>;
  log_in_by_pin: (pin: string) => Promise<Answer<LogInState>>;
  set_up: (code: string, user: string, password: string) => Promise<Answer<LogInState>>;
  log_out: () => Promise<Answer<unknown>>;
  devices: () => Promise<Answer<readonly Device[]>>;
  end: (id: string) => Promise<Answer<unknown>>;
  end_others: () => Promise<Answer<unknown>>;
  change_password: (old: string, next: string) => Promise<Answer<unknown>>;
  /** This browser. */
  pair: (name: string, pin: string) => Promise<Answer<unknown>>;
  paired: () => Promise<Answer<readonly PairedDevice[]>>;
  unpair: (id: string) => Promise<Answer<unknown>>;
  invite: (role: string) => Promise<Answer<Invitation>>;
  accept: (code: string, name: string, pin: string) => Promise<Answer<LogInState>>;
  /** Anyone may stop, logged in or not. */
  stop: () => Promise<Answer<unknown>>;
}

/** Somebody who is logged in. */
export interface Account {
  readonly calls: AccessCalls;
  readonly user: string;
  readonly role: string;
}

export const LONGEST_PIN = 8;

/** A PIN after a key: a digit, or one digit less. What does not fit changes nothing. */
export const pressed = (pin: string, key: string): string => {
  if (key === 'back') return pin.slice(0, -1);
  return /^[0-9]$/.test(key) && pin.length < LONGEST_PIN ? pin + key : pin;
};

/** Long enough to be sent; whether it is too easy to guess, the robot says. */
export const is_pin = (pin: string): boolean => /^[0-9]{4,8}$/.test(pin);

/** The one-time code behind the # of an address: "#invite=KTRF-3M7X". */
export const invitation_in = (fragment: string): string | null =>
  /^#invite=([0-9A-Za-z-]{8,9})$/.exec(fragment)?.[1] ?? null;

/** Roles that an inviter may give, the least first. */
export const roles_below = (role: string): readonly string[] => {
  const all = ['viewer', 'operator', 'admin'];
  return all.slice(0, all.indexOf(role) + 1);
};
