// The draft kept on the device: what is being edited, and which stored revision it came from. What
// is read back may be of another version or damaged, so every part is checked.

import { is_record, json_of } from './checked';
import { checked_cuts, type KeptCut } from './cuts';
import { fields_of } from './fields';
import type { PlanShape } from './on_map';
import type { Item, Plan } from './plan';
import type { Step, Steps } from './steps';

export interface Stored {
  readonly id: string;
  readonly revision: number;
}
/** A mission that was sent to be stored, and nobody answered: asked again with its key, the robot
 * gives the same one. */
export interface Tried {
  readonly key: string;
  readonly plan: Plan;
}
export interface Draft {
  readonly plan: Plan;
  /** What it is based on; null: never saved. */
  readonly stored: Stored | null;
  readonly unsaved: boolean;
  /** What can be undone and done again. */
  readonly steps?: Steps;
  /** Which of those steps cut a mission in two. */
  readonly cuts?: readonly KeptCut[];
  readonly tried?: Tried;
  /** It was to be saved, and nobody answered. */
  readonly owed?: boolean;
}

/** The robot has loaded what is edited, as it is. */
export const is_loaded = (
  stored: Stored | null,
  unsaved: boolean,
  mission: { readonly id: string | null; readonly revision: number | null } | null,
): boolean =>
  stored !== null && !unsaved && mission?.id === stored.id && mission.revision === stored.revision;

/**
 * How the edited plan is shown. While one drives, what the robot has loaded is the route itself, with what
 * is done of it and what is left: of the plan only the numbers stand on it. Any other plan is faint.
 * @param has_route the route is there to be seen
 */
export const look_of = (
  shape: PlanShape,
  drives: boolean,
  loaded: boolean,
  has_route: boolean,
): { readonly shape: PlanShape; readonly faint: boolean } => ({
  shape: drives && loaded && has_route ? 'points' : shape,
  faint: drives && !loaded,
});

const VERSION = 1;

export const draft_text = (draft: Draft): string => JSON.stringify({ version: VERSION, ...draft });

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

const is_step = (value: unknown): value is Step =>
  is_record(value) &&
  Number.isInteger(value['at']) &&
  Number.isInteger(value['gone']) &&
  Array.isArray(value['items']) &&
  value['items'].every(is_item) &&
  ['undefined', 'string'].includes(typeof value['name']) &&
  ['undefined', 'object'].includes(typeof value['home']) &&
  (value['settings'] === undefined || is_record(value['settings'])) &&
  ['undefined', 'object'].includes(typeof value['frame']) &&
  ['undefined', 'object'].includes(typeof value['drawing']);

const is_steps = (value: unknown): value is Steps =>
  is_record(value) &&
  [value['past'], value['future']].every(
    (steps) => Array.isArray(steps) && steps.every((step) => is_step(step)),
  ) &&
  (value['saved'] === null || Number.isInteger(value['saved']));

const is_tried = (value: unknown): value is Tried =>
  is_record(value) && typeof value['key'] === 'string' && is_plan(value['plan']);

/** @return null when there is none, or it is not one of ours */
export const parse_draft = (text: string | null): Draft | null => {
  const value = json_of(text);
  if (!is_record(value) || value['version'] !== VERSION || !is_plan(value['plan'])) return null;
  return {
    plan: value['plan'],
    stored: is_stored(value['stored']) ? value['stored'] : null,
    unsaved: value['unsaved'] === true,
    ...(is_steps(value['steps']) ? { steps: value['steps'] } : {}),
    ...(value['cuts'] === undefined ? {} : { cuts: checked_cuts(value['cuts']) }),
    ...(is_tried(value['tried']) ? { tried: value['tried'] } : {}),
    ...(value['owed'] === true ? { owed: true } : {}),
  };
};
