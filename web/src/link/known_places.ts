// The calls for places that are known.

import type { KnownPlaceCalls } from '../model/known_places';
import { request } from './request';
import type { components } from './schema';

type Schemas = components['schemas'];
const path_of = (name: string): string => `/known-places/${encodeURIComponent(name)}`;

export const known_place_calls: KnownPlaceCalls = {
  all: async () => {
    const answer = await request<Schemas['KnownPlaceList']>('/known-places');
    return answer.ok ? { ok: true, value: answer.value.items } : answer;
  },
  enter: (name, place) =>
    request<Schemas['KnownPlace']>(path_of(name), { method: 'PUT', body: place }),
  forget: (name) => request(path_of(name), { method: 'DELETE' }),
};
