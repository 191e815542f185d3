// Who is at this page, where the robot wants to know: log-in, first set-up, my devices.

import type { Answer } from './answer';

export interface LogInState {
  /** False: nobody has to log in. */
  readonly access: boolean;
  /** There is no user yet: the first admin is made with the code that roverd printed. */
  readonly setup: boolean;
  readonly user: string | null;
  readonly role: string | null;
  /** Of the session. */
  readonly id: string | null;
}

export interface Device {
  readonly id: string;
  readonly device: string;
  readonly address: string;
  readonly seen: string | null;
  readonly current: boolean;
}

export interface AccessCalls {
  state: () => Promise<Answer<LogInState>>;
  log_in: (user: string, password: string) => Promise<Answer<LogInState>>;
  set_up: (code: string, user: string, password: string) => Promise<Answer<LogInState>>;
  log_out: () => Promise<Answer<unknown>>;
  devices: () => Promise<Answer<readonly Device[]>>;
  end: (id: string) => Promise<Answer<unknown>>;
  /** Anyone may stop, logged in or not. */
  stop: () => Promise<Answer<unknown>>;
}

/** Somebody who is logged in. */
export interface Account {
  readonly calls: AccessCalls;
  readonly user: string;
  readonly role: string;
}
