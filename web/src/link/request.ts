// One HTTP request to the server, with a time limit; every way it can end becomes an Answer.

import type { Answer, FieldError, Refusal } from '../model/answer';
import type { Mission } from '../model/ports';
import { say } from '../model/say';
import { asked_anew } from './anew';
import { in_lane, type Lane } from './lanes';
import type { components } from './schema';

type Problem = components['schemas']['Problem'];

export interface Call {
  readonly method?: 'GET' | 'POST' | 'PUT' | 'PATCH' | 'DELETE';
  readonly body?: unknown;
  /** A file, byte for byte. */
  readonly file?: Blob;
  readonly headers?: Readonly<Record<string, string>>;
  /** Give up so long after it was sent. */
  readonly limit_ms?: number;
  readonly lane?: Lane;
  /** Gives up earlier. */
  readonly signal?: AbortSignal;
  /** What the answer is read as; a problem is always JSON. */
  readonly as?: 'json' | 'text' | 'bytes';
}

/** A link with two seconds each way is slow, not dead: connecting, asking and answering take 8 s. */
const LIMIT_MS = 15_000;

export const no_answer = (detail: string): Refusal => ({
  status: 0,
  title: say('no_answer_2'),
  detail,
  errors: [],
});

export const read_problem = async (response: Response): Promise<Refusal> => {
  const fallback = say('the_server_answered_status_statustext', {
    status: response.status,
    statustext: response.statusText,
  });
  let problem: Partial<Problem>;
  try {
    problem = (await response.json()) as Partial<Problem>;
  } catch {
    problem = {};
  }
  const errors: readonly FieldError[] = problem.errors ?? [];
  const current: Mission | undefined = problem.current;
  return {
    status: response.status,
    title: problem.title ?? response.statusText,
    detail: problem.detail ?? fallback,
    errors,
    ...(current === undefined ? {} : { current }),
    ...(problem.rest === undefined ? {} : { rest: problem.rest }),
  };
};

const fetch_options = (call: Call, hang_up?: AbortSignal): RequestInit => {
  const limit = AbortSignal.timeout(call.limit_ms ?? LIMIT_MS);
  const ends = [limit, call.signal, hang_up].filter((signal) => signal !== undefined);
  const body = call.file ?? (call.body === undefined ? undefined : JSON.stringify(call.body));
  const type = call.file === undefined ? 'application/json' : 'application/octet-stream';
  return {
    method: call.method ?? 'GET',
    headers: { ...(body === undefined ? {} : { 'Content-Type': type }), ...call.headers },
    cache: 'no-store',
    signal: AbortSignal.any(ends),
    ...(body === undefined ? {} : { body }),
  };
};

/** What a request that was not answered ended in. */
export const failed = (cause: unknown): Refusal => {
  const late = cause instanceof DOMException && cause.name === 'TimeoutError';
  return no_answer(
    late ? say('the_robot_did_not_answer_in_time') : say('the_robot_cannot_be_reached'),
  );
};

const read_body = (response: Response, as: Call['as']): Promise<unknown> => {
  if (as === 'text') return response.text();
  return as === 'bytes' ? response.arrayBuffer() : response.json();
};

const ask = (path: string, call: Call): Promise<Response> => {
  const url = `/api/v1${path}`;
  if ((call.method ?? 'GET') !== 'GET') return fetch(url, fetch_options(call));
  return asked_anew((hang_up) => fetch(url, fetch_options(call, hang_up)));
};

const sent = async <T>(path: string, call: Call): Promise<Answer<T>> => {
  try {
    const response = await ask(path, call);
    if (!response.ok) return { ok: false, refusal: await read_problem(response) };
    const value = response.status === 204 ? null : await read_body(response, call.as);
    return { ok: true, value: value as T };
  } catch (cause) {
    return { ok: false, refusal: failed(cause) };
  }
};

/** @param T what the OpenAPI document promises for success; null for an empty answer */
export const request = <T>(path: string, call: Call = {}): Promise<Answer<T>> =>
  in_lane(call.lane ?? 'other', () => sent<T>(path, call));
