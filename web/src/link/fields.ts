// The calls for fields and fences.

import type { Answer } from '../model/answer';
import type { Fence, FenceDraft } from '../model/fence';
import type { FenceCalls, RowsCalls, SurveyCalls } from '../model/ports';
import type { RowBlock, RowsWish } from '../model/row_block';
import type { Survey, SurveyWish } from '../model/survey';
import { request } from './request';
import type { components } from './schema';

type Schemas = components['schemas'];

/** Large fields take the robot's computer a while. */
const LARGE_LIMIT_MS = 30_000;

const request_of = (wish: SurveyWish): Schemas['SurveyRequest'] => ({
  polygon: [[...wish.polygon], ...wish.holes.map((hole) => [...hole])],
  spacing_m: wish.spacing_m,
  direction_deg: wish.direction_deg ?? 'best',
  pattern: wish.pattern,
  turn: wish.turn,
  ...(wish.turn === 'arc' ? { radius_m: wish.radius_m } : {}),
  start: 'vehicle',
  headland_passes: wish.headland_passes,
  overshoot_m: 0,
  order: wish.turn === 'arc' ? 'skip' : 'back_and_forth',
  ...(wish.speed_mps === null ? {} : { speed_mps: wish.speed_mps }),
});

const survey = (wish: SurveyWish): Promise<Answer<Schemas['Survey']>> =>
  request<Schemas['Survey']>('/missions/survey', {
    method: 'POST',
    body: request_of(wish),
    limit_ms: LARGE_LIMIT_MS,
  });

const survey_calls: SurveyCalls = {
  preview: async (wish): Promise<Answer<Survey>> => {
    const answer = await survey(wish);
    if (!answer.ok) return answer;
    const { mission, ...figures } = answer.value;
    return { ok: true, value: { ...figures, plan: mission } };
  },
};

const rows = (wish: RowsWish): Promise<Answer<Schemas['RowsPlan']>> => {
  const { entry, to, ...others } = wish;
  const begin = entry ? { entry: entry.at, heading_deg: entry.heading_deg % 360 } : {};
  const body: Schemas['RowsRequest'] = {
    ...others,
    ...(entry && to ? { block: [entry.at, to] } : begin),
  };
  return request<Schemas['RowsPlan']>('/missions/rows', { method: 'POST', body });
};

const rows_calls: RowsCalls = {
  preview: async (wish): Promise<Answer<RowBlock>> => {
    const answer = await rows(wish);
    if (!answer.ok) return answer;
    const { mission, ...figures } = answer.value;
    return { ok: true, value: { ...figures, plan: mission } };
  },
};

const fence_path = (id: string): string => `/fences/${encodeURIComponent(id)}`;
const if_match = (revision: number): Record<string, string> => ({
  'If-Match': `"rev-${revision}"`,
});
const draft_of = ({ name, areas, rally }: FenceDraft): object => ({
  name: name.trim(),
  areas,
  rally: rally.map(({ lat, lon }) => ({ lat, lon })),
});
const with_fence = async (
  path: string,
  call: Parameters<typeof request>[1],
): Promise<Answer<Fence>> => request<Schemas['Fence']>(path, call);

const fence_calls: FenceCalls = {
  list: () => request<Schemas['FenceList']>('/fences?limit=100'),
  read: (id) => with_fence(fence_path(id), {}),
  create: (draft) => with_fence('/fences', { method: 'POST', body: draft_of(draft) }),
  replace: (id, revision, draft) =>
    with_fence(fence_path(id), {
      method: 'PUT',
      body: draft_of(draft),
      headers: if_match(revision),
    }),
  remove: (id, revision) =>
    request<null>(fence_path(id), { method: 'DELETE', headers: if_match(revision) }),
  active: async () => {
    const answer = await request<Schemas['ActiveFence']>('/fence');
    return answer.ok ? { ok: true, value: answer.value.fence } : answer;
  },
  activate: (id) => request<unknown>('/fence', { method: 'PUT', body: { fence_id: id } }),
};

/** What is drawn on the ground and kept. */
export const field_calls = { survey: survey_calls, rows: rows_calls, fences: fence_calls };
