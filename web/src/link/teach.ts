// The calls of the teach-in.

import type { Answer } from '../model/answer';
import type { TeachCalls } from '../model/ports';
import { request } from './request';
import type { components } from './schema';

type Schemas = components['schemas'];

/** A way of a day is simplified and stored. */
const LARGE_LIMIT_MS = 30_000;

const tell = (what: string, body: object = {}): Promise<Answer<unknown>> =>
  request<Schemas['Teach']>(`/teach/${what}`, { method: 'POST', body });

export const teach_calls: TeachCalls = {
  waiting: async () => {
    const answer = await request<Schemas['Teach']>('/teach');
    return answer.ok ? { ok: true, value: answer.value.waiting } : answer;
  },
  start: (name) => tell('start', name === '' ? {} : { name }),
  pause: () => tell('pause'),
  resume: () => tell('resume'),
  discard: () => tell('discard'),
  stop: () =>
    request<Schemas['Mission']>('/teach/stop', {
      method: 'POST',
      body: {},
      limit_ms: LARGE_LIMIT_MS,
    }),
};
