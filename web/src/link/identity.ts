// Which robot this is; it says so before anybody is logged in.

import type { Answer } from '../model/answer';
import type { RobotIdentity } from '../model/identity';
import { request } from './request';
import type { components } from './schema';

type Health = components['schemas']['Health'];

export const read_identity = async (): Promise<Answer<RobotIdentity | null>> => {
  const answer = await request<Health>('/health');
  return answer.ok ? { ok: true, value: answer.value.robot } : answer;
};
