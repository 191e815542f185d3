// The calls for what the robot sees.

import type { SeenCalls } from '../model/seen';
import { request } from './request';
import type { components } from './schema';

/** Bytes of a text in base64; none where it is not. */
export const bytes_of = (text: string): Uint8Array => {
  try {
    return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  } catch {
    return new Uint8Array();
  }
};

export const seen_calls: SeenCalls = {
  landmarks: () => request<components['schemas']['KnownMarks']>('/landmarks'),
  sensors: () => request<components['schemas']['SensorList']>('/sensors'),
  capabilities: () => request<components['schemas']['Capabilities']>('/vehicle/capabilities'),
};
