// The calls of log-in. The cookie is the browser's business: no script sees it.

import type { AccessCalls, Invitation, LogInState } from '../model/access';
import { request } from './request';
import type { components } from './schema';

type SessionList = components['schemas']['SessionList'];
type DeviceList = components['schemas']['DeviceList'];

/** Comparing a password takes the robot its time. */
const LOG_IN_LIMIT_MS = 20_000;
/** The page starts without an answer, too. */
const STATE_LIMIT_MS = 4_000;

export const access_calls: AccessCalls = {
  state: () => request<LogInState>('/session', { limit_ms: STATE_LIMIT_MS }),
  log_in: (user, password) =>
    request<LogInState>('/session', {
      method: 'POST',
      body: { user, password },
      limit_ms: LOG_IN_LIMIT_MS,
    }),
  log_in_by_pin: (pin) =>
    request<LogInState>('/session', { method: 'POST', body: { pin }, limit_ms: LOG_IN_LIMIT_MS }),
  set_up: (code, user, password) =>
    request<LogInState>('/setup', {
      method: 'POST',
      body: { code, user, password },
      limit_ms: LOG_IN_LIMIT_MS,
    }),
  log_out: () => request('/session', { method: 'DELETE' }),
  devices: async () => {
    const answer = await request<SessionList>('/sessions');
    return answer.ok ? { ok: true, value: answer.value.items } : answer;
  },
  end: (id) => request(`/sessions/${encodeURIComponent(id)}`, { method: 'DELETE' }),
  end_others: () => request('/sessions', { method: 'DELETE' }),
  change_password: (password, new_password) =>
    request('/session/password', {
      method: 'POST',
      body: { password, new_password },
      limit_ms: LOG_IN_LIMIT_MS,
    }),
  pair: (name, pin) =>
    request('/devices', { method: 'POST', body: { name, pin }, limit_ms: LOG_IN_LIMIT_MS }),
  paired: async () => {
    const answer = await request<DeviceList>('/devices');
    return answer.ok ? { ok: true, value: answer.value.items } : answer;
  },
  unpair: (id) => request(`/devices/${encodeURIComponent(id)}`, { method: 'DELETE' }),
  invite: (role) => request<Invitation>('/invitations', { method: 'POST', body: { role } }),
  accept: (code, name, pin) =>
    request<LogInState>('/invitations/accept', {
      method: 'POST',
      body: { code, name, pin },
      limit_ms: LOG_IN_LIMIT_MS,
    }),
  stop: () => request('/vehicle/estop', { method: 'POST', lane: 'command' }),
};
