// The calls for graphs of nodes, along which ways are planned.

import type { NodeGraphCalls } from '../model/node_graph';
import type { Plan } from '../model/plan';
import { request } from './request';
import type { components } from './schema';

type Schemas = components['schemas'];
const path_of = (id: string): string => `/routes/${encodeURIComponent(id)}`;
/** More than anybody has. */
const MOST = 1000;

export const node_graph_calls: NodeGraphCalls = {
  all: async () => {
    const answer = await request<Schemas['RouteMapList']>(`/routes?limit=${MOST}`);
    return answer.ok ? { ok: true, value: answer.value.items } : answer;
  },
  read: (id) => request<Schemas['RouteMapWithNodes']>(path_of(id), { lane: 'bulk' }),
  add: (file, map) => {
    const name = file.name.replace(/\.[^.]*$/, '');
    const query = new URLSearchParams({ name, map }).toString();
    return request<Schemas['ImportedRouteMap']>(`/routes/import?${query}`, {
      method: 'POST',
      file,
      headers: { 'Content-Type': 'text/plain' },
      lane: 'bulk',
    });
  },
  forget: (id) => request(path_of(id), { method: 'DELETE' }),
  plan: async ({ graph, from, to }) => {
    const body = { graph, from: from ?? 'here', to };
    const answer = await request<Schemas['PlannedRoute']>('/routes/plan', { method: 'POST', body });
    return answer.ok ? { ok: true, value: answer.value.mission as Plan } : answer;
  },
};
