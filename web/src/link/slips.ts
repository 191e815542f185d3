// The calls for places where the robot slipped.

import type { Answer } from '../model/answer';
import type { Slip, SlipCalls } from '../model/slips';
import { request } from './request';
import type { components } from './schema';

type SlipList = components['schemas']['SlipList'];

/** So many are kept at most. */
const MOST_PAGES = 10;

const all = async (): Promise<Answer<readonly Slip[]>> => {
  const found: Slip[] = [];
  let cursor = '';
  for (let page = 0; page < MOST_PAGES; page += 1) {
    const answer = await request<SlipList>(`/slips?limit=200${cursor}`);
    if (!answer.ok) return answer;
    found.push(...answer.value.items);
    if (answer.value.next_cursor === null) break;
    cursor = `&cursor=${encodeURIComponent(answer.value.next_cursor)}`;
  }
  return { ok: true, value: found };
};

export const slip_calls: SlipCalls = {
  all,
  clear: () => request('/slips', { method: 'DELETE' }),
};
