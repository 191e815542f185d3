// The calls for the robot's parameters.

import type { ParameterCalls } from '../model/parameters';
import { request } from './request';
import type { components } from './schema';

type Schemas = components['schemas'];

export const parameter_calls: ParameterCalls = {
  list: async () => {
    const answer = await request<Schemas['ParameterList']>('/parameters');
    return answer.ok ? { ok: true, value: answer.value.items } : answer;
  },
  set: (name, value) =>
    request<Schemas['ParameterChanged']>(`/parameters/${encodeURIComponent(name)}`, {
      method: 'PUT',
      body: { value },
    }),
};
