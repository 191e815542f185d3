// The calls for what was driven.

import type { Answer } from '../model/answer';
import type { Plan } from '../model/plan';
import type { RunCalls } from '../model/run_ports';
import { track_of_csv, type RunTrack } from '../model/run_track';
import type { RunDetail } from '../model/runs';
import { say } from '../model/say';
import { no_answer, request } from './request';
import type { components } from './schema';

type Schemas = components['schemas'];

/** The track of a day. */
const LARGE_LIMIT_MS = 30_000;

const track = async (id: number): Promise<Answer<RunTrack>> => {
  const call = { limit_ms: LARGE_LIMIT_MS, as: 'text' } as const;
  const answer = await request<string>(`/runs/${id}/track?format=csv`, call);
  if (!answer.ok) return answer;
  const read = track_of_csv(answer.value);
  return read
    ? { ok: true, value: read }
    : { ok: false, refusal: no_answer(say('the_track_that_the_robot_sent_cannot')) };
};

const detail = async (id: number): Promise<Answer<RunDetail>> => {
  const answer = await request<Schemas['Run']>(`/runs/${id}`, { limit_ms: LARGE_LIMIT_MS });
  if (!answer.ok) return answer;
  // As it was driven: a mission in the words of the interface.
  const { plan, ...rest } = answer.value;
  return { ok: true, value: { ...rest, plan: plan as unknown as Plan } };
};

const track_address = (id: number, format: string): string =>
  `/api/v1/runs/${id}/track?format=${format}`;

export const run_calls: RunCalls = {
  list: (cursor) => {
    const from = cursor === null ? '' : `&cursor=${encodeURIComponent(cursor)}`;
    return request<Schemas['RunList']>(`/runs?limit=50${from}`);
  },
  report: (id) => request<Schemas['RunReport']>(`/runs/${id}/report`, { limit_ms: LARGE_LIMIT_MS }),
  track,
  detail,
  track_file: (id, format) =>
    request<ArrayBuffer>(`/runs/${id}/track?format=${format}`, {
      limit_ms: LARGE_LIMIT_MS,
      as: 'bytes',
    }),
  track_address,
};
