// Who did what on the robot: the rows, what is searched for, and whether they are as they were
// written.

import type { Answer } from './answer';
import type { Page } from './ports';
import { say } from './say';

export interface Deed {
  readonly id: number;
  /** Null: the robot's clock was not set. */
  readonly time: string | null;
  readonly user: string | null;
  readonly credential: string | null;
  readonly address: string | null;
  readonly call: string;
  readonly target: string | null;
  readonly status: number;
  readonly detail: string | null;
  readonly times: number;
}
/** Empty: any. */
export interface DeedFilter {
  readonly user: string;
  readonly address: string;
  /** A part of the call's name. */
  readonly call: string;
  readonly result: '' | 'done' | 'refused';
  /** As a person types it, in the browser's time zone: "2026-03-01T12:00". */
  readonly from: string;
  readonly to: string;
}
export const ANY_DEED: DeedFilter = {
  user: '',
  address: '',
  call: '',
  result: '',
  from: '',
  to: '',
};
export interface DeedCheck {
  readonly whole: boolean;
  readonly rows: number;
  /** Null: there are none. */
  readonly first: number | null;
  readonly last: number | null;
  readonly broken_at: number | null;
}
export interface AuditCalls {
  list(filter: DeedFilter, cursor: string | null): Promise<Answer<Page<Deed>>>;
  check(): Promise<Answer<DeedCheck>>;
  /** @param after the rows behind this one */
  export_address(after: number): string;
}

/** So many rows has one file. */
export const EXPORTED = 20_000;

/** The question that is asked for a filter; a time that cannot be read counts for nothing. */
export const deed_query = (filter: DeedFilter): Readonly<Record<string, string>> => {
  const out: Record<string, string> = {};
  for (const name of ['user', 'address', 'call'] as const) {
    const text = filter[name].trim();
    if (text !== '') out[name] = text;
  }
  if (filter.result !== '') out['refused'] = String(filter.result === 'refused');
  for (const name of ['from', 'to'] as const) {
    const time = new Date(filter[name]);
    if (!Number.isNaN(time.getTime())) out[name] = time.toISOString();
  }
  return out;
};

/** A status in words. */
export const result_words = (status: number): string => {
  if (status < 400) return say('result_done');
  if (status === 401) return say('not_logged_in');
  if (status === 403) return say('not_allowed');
  if (status === 429) return say('too_often');
  return status < 500 ? say('result_refused') : say('result_failed');
};

/** Who it was: their name, else where they were. */
export const doer = ({ user, address }: Deed): string => user ?? address ?? say('nobody_known');

/** "DELETE /missions/kssmx3", or the call's name where it was asked for by no path. */
export const deed_words = ({ call, target }: Deed): string => {
  if (target === null || !target.startsWith('/api/v1/')) return call;
  return `${call.split(' ', 1)[0] ?? ''} ${target.slice('/api/v1'.length)}`;
};

export const check_words = ({ whole, rows, first, last, broken_at }: DeedCheck): string => {
  if (!whole) return say('not_as_it_was_written_row_broken_at', { broken_at: broken_at ?? '?' });
  if (rows === 0) return say('nothing_has_been_written_down_yet');
  return say('whole_rows_first_to_last_are_as_they', { first: first ?? '?', last: last ?? '?' });
};

/** The files that together hold all rows. */
export const export_parts = ({
  first,
  last,
}: DeedCheck): readonly { readonly after: number; readonly label: string }[] => {
  if (first === null || last === null) return [];
  const out = [];
  for (let after = first - 1; after < last; after += EXPORTED) {
    const end = Math.min(after + EXPORTED, last);
    out.push({ after, label: say('export_rows_after_to_end', { after: after + 1, end }) });
  }
  return out;
};
