// Users of the robot and tokens of scripts, for its admins.

import type { Answer } from './answer';
import { say, told } from './say';

export const ROLES = ['viewer', 'operator', 'admin'] as const;
export type Role = (typeof ROLES)[number];

/** What they are called: the interface has the English words. */
export const role_names: Record<Role, string> = told({
  viewer: 'role_viewer',
  operator: 'role_operator',
  admin: 'role_admin',
});
/** One that this page does not know is as it came. */
export const role_name = (role: string): string =>
  ROLES.some((one) => one === role) ? role_names[role as Role] : role;

export const role_words: Record<Role, string> = told({
  viewer: 'watches_and_may_stop',
  operator: 'drives_and_plans',
  admin: 'may_everything_users_too',
});

export interface User {
  readonly name: string;
  readonly role: Role;
  /** Null: the clock was not set. */
  readonly created: string | null;
}
export interface UserDraft {
  readonly name: string;
  readonly role: Role;
  readonly password: string;
}
export interface Token {
  readonly id: string;
  readonly name: string;
  /** Who made it. */
  readonly user: string;
  readonly role: Role;
  /** Empty: all. */
  readonly methods: readonly string[];
  /** Null: never. */
  readonly expires: string | null;
  readonly used: string | null;
}
export interface TokenDraft {
  readonly name: string;
  readonly role: Role;
  readonly methods: readonly string[];
  readonly expires?: string;
}

export interface PeopleCalls {
  users(): Promise<Answer<readonly User[]>>;
  add_user(draft: UserDraft): Promise<Answer<User>>;
  change_user(
    name: string,
    change: { readonly role?: Role; readonly password?: string },
  ): Promise<Answer<User>>;
  remove_user(name: string): Promise<Answer<unknown>>;
  tokens(): Promise<Answer<readonly Token[]>>;
  /** @return its secret, which is told this once */
  add_token(draft: TokenDraft): Promise<Answer<string>>;
  end_token(id: string): Promise<Answer<unknown>>;
}

/** How long a new token holds; null: until it is ended. */
export const TOKEN_DAYS: readonly (number | null)[] = [1, 7, 30, 365, null];

export const days_words = (days: number | null): string =>
  days === null
    ? say('until_it_is_ended')
    : days === 1
      ? say('for_a_day')
      : say('for_days_days', { days });

const DAY_MS = 86_400_000;

/** What the form asks for. @param now_ms Unix time of the robot's clock: that one decides */
export const token_draft = (
  name: string,
  role: Role,
  reads_only: boolean,
  days: number | null,
  now_ms: number,
): TokenDraft => ({
  name: name.trim(),
  role,
  methods: reads_only ? ['GET'] : [],
  ...(days === null ? {} : { expires: new Date(now_ms + days * DAY_MS).toISOString() }),
});

/** "operator, reads only, until 2026-05-01 12:00" @param day_and_time how a stamp is written */
export const token_words = (
  { role, methods, expires }: Token,
  day_and_time: (stamp: string) => string,
): string =>
  [
    role_names[role],
    ...(methods.length === 0
      ? []
      : [methods.join() === 'GET' ? say('reads_only') : methods.join(', ')]),
    expires === null
      ? say('without_end')
      : say('until_expires', { expires: day_and_time(expires) }),
  ].join(', ');
