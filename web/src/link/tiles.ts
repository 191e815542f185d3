// The calls for map tiles: the robot's sets, and those of the network.

import type { Answer } from '../model/answer';
import type { TileCalls, TileSet } from '../model/ground';
import { failed, no_answer, request } from './request';
import type { components } from './schema';

type Schemas = components['schemas'];

/** A piece over the weakest link; with the last one the robot looks at the whole file. */
const PIECE_LIMIT_MS = 120_000;
const NETWORK_LIMIT_MS = 30_000;

const path = (set: string): string => `/tiles/${encodeURIComponent(set)}`;
const json = { 'Content-Type': 'application/json' };

const from_network = async (url: string): Promise<Answer<Blob | null>> => {
  try {
    const response = await fetch(url, {
      signal: AbortSignal.timeout(NETWORK_LIMIT_MS),
      credentials: 'omit',
      referrerPolicy: 'no-referrer',
    });
    if (response.status === 404 || response.status === 204) return { ok: true, value: null };
    if (response.ok) return { ok: true, value: await response.blob() };
    return { ok: false, refusal: no_answer(`${response.status} ${response.statusText}`.trim()) };
  } catch (cause) {
    return { ok: false, refusal: failed(cause) };
  }
};

export const tile_calls: TileCalls = {
  list: () => request<Schemas['TileSetList']>('/tiles'),
  create: (set) => request<TileSet>('/tiles', { method: 'POST', body: set, headers: json }),
  put: (set, { z, x, y }, picture) =>
    request<null>(`${path(set)}/${z}/${x}/${y}`, { method: 'PUT', file: picture }),
  send: async (set, offset, size, piece) => {
    const answer = await request<Schemas['TileSet'] | Schemas['UnfinishedTileFile']>(
      `${path(set)}/file?offset=${offset}&size=${size}`,
      { method: 'PUT', file: piece, limit_ms: PIECE_LIMIT_MS, lane: 'bulk' },
    );
    if (!answer.ok) return answer;
    return { ok: true, value: 'format' in answer.value ? answer.value : null };
  },
  change: (set, change) =>
    request<TileSet>(path(set), { method: 'PATCH', body: change, headers: json }),
  remove: (set) => request<null>(path(set), { method: 'DELETE' }),
  fetch: from_network,
};
