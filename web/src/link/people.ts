// The calls for users and tokens.

import type { PeopleCalls, Token, User } from '../model/people';
import { request } from './request';
import type { components } from './schema';

type Schemas = components['schemas'];

/** Hashing a password takes the robot its time. */
const PASSWORD_LIMIT_MS = 20_000;

export const people_calls: PeopleCalls = {
  users: async () => {
    const answer = await request<Schemas['UserList']>('/users');
    return answer.ok ? { ok: true, value: answer.value.items } : answer;
  },
  add_user: (body) =>
    request<User>('/users', { method: 'POST', body, limit_ms: PASSWORD_LIMIT_MS }),
  change_user: (name, body) =>
    request<User>(`/users/${encodeURIComponent(name)}`, {
      method: 'PATCH',
      body,
      limit_ms: PASSWORD_LIMIT_MS,
    }),
  remove_user: (name) => request(`/users/${encodeURIComponent(name)}`, { method: 'DELETE' }),
  tokens: async () => {
    const answer = await request<{ items: readonly Token[] }>('/tokens');
    return answer.ok ? { ok: true, value: answer.value.items } : answer;
  },
  add_token: async (body) => {
    const answer = await request<Schemas['NewToken']>('/tokens', { method: 'POST', body });
    return answer.ok ? { ok: true, value: answer.value.token } : answer;
  },
  end_token: (id) => request(`/tokens/${encodeURIComponent(id)}`, { method: 'DELETE' }),
};
