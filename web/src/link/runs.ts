// The calls for what was driven.

import type { Answer } from '../model/answer';
import type { LatLon, Plan } from '../model/plan';
import type { RunCalls } from '../model/ports';
import { request } from './request';
import type { components } from './schema';

type Schemas = components['schemas'];

/** The track of a day. */
const LARGE_LIMIT_MS = 30_000;

interface Track {
  readonly features: readonly {
    readonly geometry: { readonly coordinates: readonly (readonly [lon: number, lat: number])[] };
  }[];
}

const track = async (id: number): Promise<Answer<readonly (readonly LatLon[])[]>> => {
  const answer = await request<Track>(`/runs/${id}/track`, { limit_ms: LARGE_LIMIT_MS });
  if (!answer.ok) return answer;
  const lines = answer.value.features.map(({ geometry }) =>
    geometry.coordinates.map(([lon, lat]) => ({ lat, lon })),
  );
  return { ok: true, value: lines };
};

const plan = async (id: number): Promise<Answer<Plan>> => {
  const answer = await request<Schemas['Run']>(`/runs/${id}`, { limit_ms: LARGE_LIMIT_MS });
  // As it was driven: a mission in the words of the interface.
  return answer.ok ? { ok: true, value: answer.value.plan as unknown as Plan } : answer;
};

export const run_calls: RunCalls = {
  list: (cursor) => {
    const from = cursor === null ? '' : `&cursor=${encodeURIComponent(cursor)}`;
    return request<Schemas['RunList']>(`/runs?limit=50${from}`);
  },
  report: (id) => request<Schemas['RunReport']>(`/runs/${id}/report`, { limit_ms: LARGE_LIMIT_MS }),
  track,
  plan,
  track_address: (id, format) => `/api/v1/runs/${id}/track?format=${format}`,
};
