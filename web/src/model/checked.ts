// What was kept on the device may be of another version, or damaged: looked at before it is taken.

import type { LatLon } from './plan';

export const is_record = (value: unknown): value is Readonly<Record<string, unknown>> =>
  typeof value === 'object' && value !== null && !Array.isArray(value);

export const is_place = (value: unknown): value is LatLon =>
  is_record(value) && Number.isFinite(value['lat']) && Number.isFinite(value['lon']);

export const is_list_of = <T>(
  value: unknown,
  is_one: (one: unknown) => one is T,
): value is readonly T[] => Array.isArray(value) && value.every((one) => is_one(one));

/** @return undefined: it is no JSON */
export const json_of = (text: string | null): unknown => {
  if (text === null) return undefined;
  try {
    return JSON.parse(text) as unknown;
  } catch {
    return undefined;
  }
};
