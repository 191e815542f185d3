// The calls for who did what.

import { deed_query, type AuditCalls } from '../model/audit';
import { request } from './request';
import type { components } from './schema';

type Schemas = components['schemas'];

/** All rows are gone through. */
const CHECK_LIMIT_MS = 60_000;

export const audit_calls: AuditCalls = {
  list: (filter, cursor) => {
    const query = new URLSearchParams(deed_query(filter));
    query.set('limit', '50');
    if (cursor !== null) query.set('cursor', cursor);
    return request<Schemas['AuditList']>(`/audit?${query.toString()}`);
  },
  check: () => request<Schemas['AuditCheck']>('/audit/check', { limit_ms: CHECK_LIMIT_MS }),
  export_address: (after) => `/api/v1/audit/export?format=csv&after=${after}`,
};
