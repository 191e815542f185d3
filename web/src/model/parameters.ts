// The robot's parameters: sorted into groups, searched, read from what a person typed, kept in a file
// and compared with one.

import type { Answer } from './answer';
import { say, told } from './say';

export type ParameterValue = number | boolean | string;

export interface Parameter {
  /** "nav.track.corner_deviation_m" */
  readonly name: string;
  readonly type: 'number' | 'integer' | 'boolean' | 'text';
  readonly unit: string | null;
  readonly value: ParameterValue;
  readonly default: ParameterValue;
  /** What the next start begins with. */
  readonly next_start_value: ParameterValue;
  readonly min: number | null;
  readonly max: number | null;
  readonly description: string;
  readonly acts: 'at_once' | 'at_next_load' | 'at_next_start';
  /** Of what keeps people safe: the side to which it may be changed while the robot is armed. */
  readonly stricter: 'lower' | 'higher' | 'none' | null;
}
export interface ParameterChanged extends Parameter {
  readonly acted: boolean;
  readonly waits_for: string | null;
}
export interface ParameterCalls {
  list(): Promise<Answer<readonly Parameter[]>>;
  set(name: string, value: ParameterValue): Promise<Answer<ParameterChanged>>;
}

/** What a person chose, whether it acts already or not. */
export const chosen_value = (one: Parameter): ParameterValue => one.next_start_value;
export const is_changed = (one: Parameter): boolean => chosen_value(one) !== one.default;
export const waits_for_start = (one: Parameter): boolean => one.next_start_value !== one.value;

/** "nav.track.damping" → "nav.track" */
export const group_of = (name: string): string =>
  name.includes('.') ? name.slice(0, name.lastIndexOf('.')) : name;
/** "nav.track.corner_deviation_m" → "corner deviation m" */
export const short_name = (name: string): string =>
  name.slice(name.lastIndexOf('.') + 1).replaceAll('_', ' ');

/** With its unit, unless the name ends with it. */
export const label_of = ({ name, unit }: Parameter): string => {
  const short = short_name(name);
  return unit === null || short.endsWith(` ${unit}`) ? short : `${short}, ${unit}`;
};

export interface ParameterGroup {
  readonly name: string;
  readonly items: readonly Parameter[];
}

/** Those that fit, group by group. @param text words that all occur in the name or its meaning */
export const grouped = (
  all: readonly Parameter[],
  text: string,
  changed_only: boolean,
): readonly ParameterGroup[] => {
  const words = text.toLowerCase().split(/\s+/).filter(Boolean);
  const groups = new Map<string, Parameter[]>();
  for (const one of all) {
    if (changed_only && !is_changed(one)) continue;
    const said = `${one.name} ${short_name(one.name)} ${one.description}`.toLowerCase();
    if (!words.every((word) => said.includes(word))) continue;
    const group = group_of(one.name);
    groups.set(group, [...(groups.get(group) ?? []), one]);
  }
  return [...groups]
    .map(([name, items]) => ({ name, items }))
    .sort((a, b) => (a.name < b.name ? -1 : 1));
};

export const value_text = (value: ParameterValue): string =>
  typeof value === 'boolean'
    ? value
      ? say('word_on')
      : say('word_off')
    : value === ''
      ? say('word_empty')
      : String(value);

/** "0 … 5 m/s", or the side on which there is a limit. */
export const range_text = ({ min, max, unit }: Parameter): string => {
  const of_unit = unit ? ` ${unit}` : '';
  if (min !== null && max !== null) return `${min} … ${max}${of_unit}`;
  if (min !== null) return say('from_min_of_unit', { min, of_unit });
  return max !== null ? say('to_max_of_unit', { max, of_unit }) : (unit ?? '');
};

export const acts_words: Record<Parameter['acts'], string> = told({
  at_once: 'acts_at_once',
  at_next_load: 'acts_with_the_next_mission_that_is',
  at_next_start: 'acts_at_the_next_start_of_the_program',
});

/** What was typed, or why it cannot be that. */
export type Typed =
  | { readonly ok: true; readonly value: ParameterValue }
  | { readonly ok: false; readonly why: string };

/** Whether a value fits, before the robot is asked; it has the last word. */
const fitting = (one: Parameter, value: unknown): Typed => {
  const no = (why: string): Typed => ({ ok: false, why });
  if (one.type === 'boolean') {
    return typeof value === 'boolean' ? { ok: true, value } : no(say('must_be_on_or_off'));
  }
  if (one.type === 'text') {
    return typeof value === 'string' ? { ok: true, value } : no(say('must_be_a_text'));
  }
  if (typeof value !== 'number' || !Number.isFinite(value)) return no(say('must_be_a_number'));
  if (one.type === 'integer' && !Number.isInteger(value)) return no(say('must_be_a_whole_number'));
  const low = one.min !== null && value < one.min;
  const high = one.max !== null && value > one.max;
  return low || high ? no(say('must_be_in_one', { one: range_text(one) })) : { ok: true, value };
};

/** @param text of a field; a comma is a decimal point, too */
export const typed = (one: Parameter, text: string): Typed => {
  if (one.type === 'text') return { ok: true, value: text };
  if (one.type === 'boolean')
    return fitting(one, text === 'on' ? true : text === 'off' ? false : 0);
  const bare = text.trim().replace(',', '.');
  return fitting(one, bare === '' ? NaN : Number(bare));
};

const FORMAT = 'roverd-parameters';

/** A file of all of them. */
export const file_of = (all: readonly Parameter[]): string => {
  const values = Object.fromEntries(all.map((one) => [one.name, chosen_value(one)]));
  return `${JSON.stringify({ format: FORMAT, parameters: values }, null, 1)}\n`;
};

export interface Difference {
  readonly parameter: Parameter;
  readonly value: ParameterValue;
}
export interface Compared {
  /** What the file has otherwise than this robot. */
  readonly differ: readonly Difference[];
  readonly left_out: readonly { readonly name: string; readonly why: string }[];
}

/** What a file would change. @return why it is none, in words */
export const compared = (text: string, all: readonly Parameter[]): Compared | string => {
  let said: unknown;
  try {
    const file = JSON.parse(text) as { format?: unknown; parameters?: unknown } | null;
    if (file?.format !== FORMAT) return say('this_is_no_file_of_parameters');
    said = file.parameters;
  } catch {
    return say('this_is_no_file_of_parameters');
  }
  if (typeof said !== 'object' || said === null || Array.isArray(said)) {
    return say('there_are_no_parameters_in_the_file');
  }
  const known = new Map(all.map((one) => [one.name, one]));
  const differ: Difference[] = [];
  const left_out: { name: string; why: string }[] = [];
  for (const [name, value] of Object.entries(said)) {
    const parameter = known.get(name);
    const found: Typed = parameter
      ? fitting(parameter, value)
      : { ok: false, why: say('is_not_known_here') };
    if (!found.ok) left_out.push({ name, why: found.why });
    else if (parameter && found.value !== chosen_value(parameter)) {
      differ.push({ parameter, value: found.value });
    }
  }
  return { differ, left_out };
};
