// The calls of control.

import type { Answer } from '../model/answer';
import type { ControlCalls, ControlState } from '../model/control';
import { request } from './request';
import type { components } from './schema';

type Control = components['schemas']['Control'];

const tell = (what: string, body: object): Promise<Answer<ControlState>> =>
  request<Control>(`/control/${what}`, { method: 'POST', body, lane: 'command' });

export const control_calls: ControlCalls = {
  state: () => request<Control>('/control'),
  take: (wish) => tell('take', wish),
  release: () => tell('release', {}),
  hand_over: (to, accept) => tell('handover', { accept, to }),
};
