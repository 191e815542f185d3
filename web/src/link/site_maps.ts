// The calls for maps of a place in the plane.

import type { Answer } from '../model/answer';
import { say } from '../model/say';
import { MOST_CELLS, read_cells } from '../model/site_cells';
import {
  type MapFiles,
  type SiteMap,
  type SiteMapCalls,
  type TaggedCells,
} from '../model/site_map';
import { in_lane } from './lanes';
import { failed, no_answer, read_problem, request } from './request';
import type { components } from './schema';

type Schemas = components['schemas'];

/** A map of 10,000 by 10,000 cells over a weak radio link. */
const SEND_LIMIT_MS = 600_000;
/** All cells of a map are read and written. */
const WORK_LIMIT_MS = 60_000;
/** The cells of a map come over the slowest link, as long as some of them come. */
const SILENCE_LIMIT_MS = 20_000;
/** Of a long drive the last loops are closed before it is drawn. */
const DRAW_LIMIT_MS = 180_000;

const path = (id: number): string => `/maps/${id}`;

/** As fetch cannot: it tells how much of it is sent. */
const post = (
  form: FormData,
  sent: (share: number) => void,
): Promise<{ readonly status: number; readonly text: string }> =>
  new Promise((resolve, reject) => {
    const call = new XMLHttpRequest();
    call.open('POST', '/api/v1/maps');
    call.timeout = SEND_LIMIT_MS;
    call.upload.addEventListener('progress', ({ lengthComputable, loaded, total }) => {
      if (lengthComputable && total > 0) sent(loaded / total);
    });
    call.addEventListener('load', () => resolve({ status: call.status, text: call.responseText }));
    call.addEventListener('error', () => reject(new Error('not reached')));
    call.addEventListener('timeout', () => reject(new DOMException('late', 'TimeoutError')));
    call.send(form);
  });

const add = async (files: MapFiles, sent: (share: number) => void): Promise<Answer<SiteMap>> => {
  const form = new FormData();
  for (const [field, file] of Object.entries(files)) form.set(field, file as File);
  try {
    const { status, text } = await in_lane('bulk', () => post(form, sent));
    const answer = new Response(text === '' ? null : text, { status });
    if (!answer.ok) return { ok: false, refusal: await read_problem(answer) };
    return { ok: true, value: JSON.parse(text) as Schemas['Map'] };
  } catch (cause) {
    return { ok: false, refusal: failed(cause) };
  }
};

/** All that comes, as long as something does. */
const bytes_of = async (answer: Response, heard: () => void): Promise<Uint8Array> => {
  const parts: BlobPart[] = [];
  const reader = answer.body?.getReader();
  for (;;) {
    const part = await reader?.read();
    if (!part || part.done) return new Uint8Array(await new Blob(parts).arrayBuffer());
    heard();
    parts.push(part.value);
  }
};

/** Only those that are not known yet. */
const fetch_cells = async (
  id: number,
  tag: string | null,
  given_up: AbortSignal,
): Promise<Answer<TaggedCells | null>> => {
  const silent = new AbortController();
  let limit: ReturnType<typeof setTimeout> | undefined;
  const heard = (): void => {
    clearTimeout(limit);
    const late = new DOMException('late', 'TimeoutError');
    limit = setTimeout(() => silent.abort(late), SILENCE_LIMIT_MS);
  };
  heard();
  try {
    const answer = await fetch(`/api/v1${path(id)}/cells?most=${MOST_CELLS}`, {
      cache: 'no-store',
      signal: AbortSignal.any([given_up, silent.signal]),
      headers: tag === null ? {} : { 'If-None-Match': tag },
    });
    if (answer.status === 304) return { ok: true, value: null };
    if (!answer.ok) return { ok: false, refusal: await read_problem(answer) };
    const thinned = Number(answer.headers.get('Roverd-Thinned') ?? '1');
    const cells = read_cells(await bytes_of(answer, heard), thinned);
    if (!cells) return { ok: false, refusal: no_answer(say('what_came_is_no_picture_of_a_map')) };
    return { ok: true, value: { ...cells, tag: answer.headers.get('ETag') } };
  } catch (cause) {
    return { ok: false, refusal: failed(cause) };
  } finally {
    clearTimeout(limit);
  }
};

export const site_map_calls: SiteMapCalls = {
  list: () => request<Schemas['MapList']>('/maps'),
  read: (id) => request<Schemas['Map']>(path(id)),
  add,
  change: (id, change) =>
    request<Schemas['Map']>(path(id), { method: 'PATCH', body: change, limit_ms: WORK_LIMIT_MS }),
  remove: (id) => request<null>(path(id), { method: 'DELETE' }),
  use: (id) =>
    request<unknown>(id === null ? '/maps/unuse' : `${path(id)}/use`, {
      method: 'POST',
      limit_ms: WORK_LIMIT_MS,
    }),
  cells: (id, tag, signal) => in_lane('bulk', () => fetch_cells(id, tag, signal)),
  start_making: () => request<Schemas['MapMaking']>('/maps/start', { method: 'POST' }),
  finish_making: (name) =>
    request<Schemas['Map']>('/maps/stop', {
      method: 'POST',
      body: name === '' ? {} : { name },
      limit_ms: DRAW_LIMIT_MS,
    }),
  drop_making: () => request<null>('/maps/stop', { method: 'POST', body: { discard: true } }),
  file_address: (id, format) => `/api/v1${path(id)}/export?format=${format}`,
};
