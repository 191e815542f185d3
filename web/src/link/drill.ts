// The calls for the drill.

import type { Drill } from '../model/drill';
import type { DrillCalls } from '../model/ports';
import { request } from './request';
import type { components } from './schema';

type Schemas = components['schemas'];
const PATH = '/safety/drill';
/** A long mission is laid out before the answer comes. */
const LARGE_LIMIT_MS = 30_000;

export const drill_calls: DrillCalls = {
  read: () => request<Drill>(PATH),
  begin: ({ mission, at_m, failures }) => {
    const body: Schemas['StartDrill'] = {
      ...(mission ? { mission_id: mission.id, revision: mission.revision } : {}),
      ...(at_m === undefined ? {} : { at_m }),
      ...(failures ? { failures: [...failures] as Schemas['DrillFailureId'][] } : {}),
    };
    return request<Drill>(PATH, { method: 'POST', body, limit_ms: LARGE_LIMIT_MS });
  },
  cancel: () => request<Drill>(PATH, { method: 'DELETE' }),
};
