// The draft kept on the device: what is being edited, and which stored revision it came from. What
// is read back may be of another version or damaged, so every part is checked.

import { fields_of } from './fields';
import type { Item, Plan } from './plan';

export interface Stored {
  readonly id: string;
  readonly revision: number;
}
export interface Draft {
  readonly plan: Plan;
  /** What it is based on; null: never saved. */
  readonly stored: Stored | null;
  readonly unsaved: boolean;
}

const VERSION = 1;

export const draft_text = (draft: Draft): string => JSON.stringify({ version: VERSION, ...draft });

const is_record = (value: unknown): value is Record<string, unknown> =>
  typeof value === 'object' && value !== null && !Array.isArray(value);

/** Every field that the kind of item needs is there and of the right type. */
const is_item = (value: unknown): value is Item => {
  if (!is_record(value) || typeof value['type'] !== 'string') return false;
  const fields = (fields_of as Partial<Record<string, (typeof fields_of)['wait']>>)[value['type']];
  return (
    fields?.every((field) => {
      const content = value[field.key];
      if (content === undefined || content === null) {
        return field.kind !== 'text' && (field.kind !== 'number' || field.optional);
      }
      switch (field.kind) {
        case 'number':
          return typeof content === 'number';
        case 'flag':
          return typeof content === 'boolean';
        case 'choice':
        case 'text':
          return typeof content === 'string';
      }
    }) ?? false
  );
};

const is_plan = (value: unknown): value is Plan =>
  is_record(value) &&
  typeof value['name'] === 'string' &&
  Array.isArray(value['items']) &&
  value['items'].every(is_item);

const is_stored = (value: unknown): value is Stored =>
  is_record(value) && typeof value['id'] === 'string' && typeof value['revision'] === 'number';

/** @return null when there is none, or it is not one of ours */
export const parse_draft = (text: string | null): Draft | null => {
  if (text === null) return null;
  let value: unknown;
  try {
    value = JSON.parse(text);
  } catch {
    return null;
  }
  if (!is_record(value) || value['version'] !== VERSION || !is_plan(value['plan'])) return null;
  return {
    plan: value['plan'],
    stored: is_stored(value['stored']) ? value['stored'] : null,
    unsaved: value['unsaved'] === true,
  };
};
