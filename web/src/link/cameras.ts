// The calls for cameras. Pictures have a way of their own, beside the lanes: one at a time, so a slow
// one holds up nothing but the next.

import type { CameraCalls, Glimpse } from '../model/camera';
import { request } from './request';
import type { components } from './schema';

const number_in = (response: Response, name: string): number =>
  Number(response.headers.get(name) ?? Number.NaN);

export const camera_calls: CameraCalls = {
  list: async () => {
    const answer = await request<components['schemas']['CameraList']>('/cameras');
    return answer.ok ? { ok: true, value: answer.value.items } : answer;
  },
  look: async (name, after, divisor, signal): Promise<Glimpse | null> => {
    const query = new URLSearchParams({ divisor: String(divisor) });
    if (after !== null) query.set('after', String(after));
    try {
      const response = await fetch(
        `/api/v1/cameras/${encodeURIComponent(name)}/snapshot?${query.toString()}`,
        { cache: 'no-store', signal },
      );
      const count = number_in(response, 'Picture-Count');
      const age_ms = number_in(response, 'Picture-Age-Ms');
      if (!response.ok || Number.isNaN(count) || Number.isNaN(age_ms)) return null;
      return {
        picture: response.status === 200 ? await response.arrayBuffer() : null,
        count,
        age_ms,
      };
    } catch {
      return null;
    }
  },
};
