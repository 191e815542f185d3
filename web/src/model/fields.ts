// The fields of every kind of item: label, unit, range. One table makes the editor, reads what was
// typed and names what is wrong. The server checks again.

import type { Item, ItemType, Landmarks, LatLon, Side } from './plan';
import { type PlainKey, say, told } from './say';

export interface NumberField {
  readonly kind: 'number';
  readonly key: string;
  readonly label: PlainKey;
  readonly unit: string;
  readonly min: number;
  readonly max: number;
  /** May be left empty. */
  readonly optional: boolean;
  readonly whole?: boolean;
}
export interface ChoiceField {
  readonly kind: 'choice';
  readonly key: string;
  readonly label: PlainKey;
  readonly choices: readonly (readonly [value: string, label: PlainKey])[];
}
export interface TextField {
  readonly kind: 'text';
  readonly key: string;
  readonly label: PlainKey;
}
export interface FlagField {
  readonly kind: 'flag';
  readonly key: string;
  readonly label: PlainKey;
}
export type Field = NumberField | ChoiceField | TextField | FlagField;

type Range = readonly [min: number, max: number];

const must = (key: string, label: PlainKey, unit: string, [min, max]: Range): NumberField => ({
  kind: 'number',
  key,
  label,
  unit,
  min,
  max,
  optional: false,
});
const may = (key: string, label: PlainKey, unit: string, range: Range): NumberField => ({
  ...must(key, label, unit, range),
  optional: true,
});
const whole = (field: NumberField): NumberField => ({ ...field, whole: true });

const SIDE: ChoiceField = {
  kind: 'choice',
  key: 'side',
  label: 'side',
  choices: [
    ['left', 'left'],
    ['right', 'right'],
  ],
};
const ROW_SIDE: ChoiceField = { ...SIDE, choices: [['both', 'both_the_middle'], ...SIDE.choices] };
const SEEING: ChoiceField = {
  kind: 'choice',
  key: 'seeing',
  label: 'seen_by',
  choices: [
    ['line', 'lines'],
    ['rays', 'outermost_rays'],
  ],
};
const SOURCE: ChoiceField = {
  kind: 'choice',
  key: 'source',
  label: 'seen_by',
  choices: [
    ['', 'word_default'],
    ['auto', 'whoever_sees_it'],
    ['scan', 'scanners_only'],
    ['vision', 'cameras_only'],
  ],
};
const TURN: ChoiceField = {
  kind: 'choice',
  key: 'turn',
  label: 'turn_style',
  choices: [
    ['auto', 'automatic'],
    ['pivot', 'on_the_spot'],
    ['arc', 'arc'],
    ['through', 'drive_through'],
  ],
};
const FAR: Range = [-10_000, 10_000];

export const fields_of: Record<ItemType, readonly Field[]> = {
  waypoint: [
    must('lat', 'latitude', '°', [-90, 90]),
    must('lon', 'longitude', '°', [-180, 180]),
    may('speed_mps', 'speed', 'm/s', [0.01, 10]),
    may('hold_s', 'hold_2', 's', [0, 86_400]),
    may('radius_m', 'radius', 'm', [0.01, 100]),
    TURN,
    { kind: 'flag', key: 'reverse', label: 'drive_backwards' },
  ],
  local: [
    must('east_m', 'east', 'm', FAR),
    must('north_m', 'north', 'm', FAR),
    may('heading_deg', 'heading', '°', [0, 360]),
  ],
  map_point: [
    must('x_m', 'x_in_the_map', 'm', FAR),
    must('y_m', 'y_in_the_map', 'm', FAR),
    may('yaw_deg', 'points_to_in_the_map', '°', [-360, 360]),
    may('speed_mps', 'speed', 'm/s', [0.01, 10]),
    may('hold_s', 'hold_2', 's', [0, 86_400]),
    may('radius_m', 'radius', 'm', [0.01, 100]),
    { kind: 'flag', key: 'reverse', label: 'drive_backwards' },
  ],
  move: [must('forward_m', 'forward', 'm', FAR)],
  turn: [
    may('turn_deg', 'turn_by', '°', [-3600, 3600]),
    may('heading_deg', 'turn_to_heading', '°', [0, 360]),
    may('radius_m', 'turn_on_an_arc_of', 'm', [0.1, 100]),
  ],
  wait: [must('seconds', 'wait', 's', [0, 86_400])],
  speed: [must('speed_mps', 'speed', 'm/s', [0.01, 10])],
  row: [
    ROW_SIDE,
    may('gap_m', 'gap_along_one_side', 'm', [0.01, 20]),
    may('speed_mps', 'speed', 'm/s', [0.01, 10]),
    may('distance_m', 'ends_after', 'm', [0.01, 10_000]),
    SEEING,
  ],
  wall: [
    SIDE,
    may('distance_m', 'distance', 'm', [0.01, 20]),
    may('speed_mps', 'speed', 'm/s', [0.01, 10]),
    may('length_m', 'ends_after', 'm', [0.01, 10_000]),
    SOURCE,
    { kind: 'flag', key: 'landmarks_first', label: 'landmarks_first' },
  ],
  landmarks: [
    { kind: 'text', key: 'name', label: 'name' },
    SIDE,
    may('offset_m', 'offset', 'm', [-20, 20]),
    may('speed_mps', 'speed', 'm/s', [0.01, 10]),
    whole(may('count', 'ends_after', '', [0, 10_000])),
    SOURCE,
  ],
  dock: [
    whole(must('tag', 'tag', '', [0, 586])),
    may('stand_off_m', 'stands_before_it', 'm', [0.1, 5]),
  ],
  jump: [
    whole(must('item', 'to_item', '', [1, 1_000_000])),
    whole(must('times', 'times_0_for_ever', '', [0, 1_000_000])),
  ],
  return_home: [],
  action: [{ kind: 'text', key: 'name', label: 'name' }],
  loiter: [
    may('lat', 'latitude', '°', [-90, 90]),
    may('lon', 'longitude', '°', [-180, 180]),
    may('seconds', 'stay', 's', [0, 86_400]),
    may('radius_m', 'back_beyond', 'm', [0.1, 100]),
  ],
  circle: [
    must('lat', 'latitude', '°', [-90, 90]),
    must('lon', 'longitude', '°', [-180, 180]),
    must('radius_m', 'radius', 'm', [0.5, 1000]),
    may('turns', 'turns', '', [0.05, 1000]),
    may('speed_mps', 'speed', 'm/s', [0.01, 10]),
    whole(may('stations', 'looks_in_a_turn', '', [0, 36])),
    may('hold_s', 'hold_there', 's', [0, 86_400]),
    { kind: 'flag', key: 'clockwise', label: 'clockwise' },
  ],
};

/** A new item of a kind, with sensible values. Waypoints are made on the map. */
export const fresh_item = (type: Exclude<ItemType, 'waypoint'>, near: LatLon | null): Item => {
  switch (type) {
    case 'local':
      return { type, east_m: 0, north_m: 0 };
    case 'map_point':
      return { type, x_m: 0, y_m: 0 };
    case 'move':
      return { type, forward_m: 1 };
    case 'turn':
      return { type, turn_deg: 90 };
    case 'wait':
      return { type, seconds: 5 };
    case 'speed':
      return { type, speed_mps: 0.5 };
    case 'row':
      return { type, side: 'both' };
    case 'wall':
      return { type, side: 'left' };
    case 'landmarks':
      return { type, name: 'cone', side: 'right' };
    case 'dock':
      return { type, tag: 0 };
    case 'jump':
      return { type, item: 1, times: 1 };
    case 'return_home':
      return { type };
    case 'action':
      return { type, name: 'action' };
    case 'loiter':
      return near ? { type, ...near, seconds: 30 } : { type, seconds: 30 };
    case 'circle':
      return { type, ...(near ?? { lat: 0, lon: 0 }), radius_m: 5, turns: 1 };
  }
};

export const type_words: Record<ItemType, string> = told({
  waypoint: 'waypoint',
  local: 'local_point',
  map_point: 'map_point',
  move: 'move_straight',
  turn: 'turn',
  wait: 'wait',
  speed: 'change_speed',
  row: 'follow_row',
  wall: 'follow_wall',
  landmarks: 'follow_landmarks',
  dock: 'dock_at_a_tag',
  jump: 'jump',
  return_home: 'return_home',
  action: 'action',
  loiter: 'stay_at_a_place',
  circle: 'circle',
});

export type Read =
  | { readonly ok: true; readonly value: number | null }
  | { readonly ok: false; readonly error: string };

/** Reads what a person typed; a comma counts as a decimal point. @param label what the field is
 * called @param per how many of what is typed one of the field's unit is: 3.6 for km/h */
export const read_number = (
  field: Omit<NumberField, 'label'>,
  text: string,
  label: string,
  per = 1,
): Read => {
  const typed = text.trim().replace(',', '.').replace('−', '-');
  if (typed === '') {
    return field.optional
      ? { ok: true, value: null }
      : { ok: false, error: say('label_is_needed', { label }) };
  }
  const value = Number(typed) / per;
  if (!Number.isFinite(value))
    return { ok: false, error: say('label_must_be_a_number', { label }) };
  if (field.whole === true && !Number.isInteger(value)) {
    return {
      ok: false,
      error: say('label_must_be_a_whole_number', { label }),
    };
  }
  if (value < field.min || value > field.max) {
    return {
      ok: false,
      error: say('label_must_be_from_min_to_max', {
        label,
        min: field.min * per,
        max: field.max * per,
      }),
    };
  }
  return { ok: true, value: per === 1 ? value : Number(value.toFixed(4)) };
};

/** Of the vehicle, where they are: an offset says it by its sign. */
const side_of = ({ offset_m, side }: Landmarks): Side => {
  if (typeof offset_m === 'number') return offset_m > 0 ? 'right' : 'left';
  return side ?? 'left';
};

/** Landmarks have an offset, with its side, or a side alone: never neither. A first offset without a
 * sign lies on the side that was chosen: nobody who types a distance wants the other one. */
const with_side = (item: Landmarks, key: string, value: unknown): Landmarks => {
  const { offset_m, ...others } = item;
  const rest = Object.fromEntries(
    Object.entries(others).filter(([name]) => name !== 'side'),
  ) as unknown as Landmarks;
  if (key === 'offset_m') {
    const side = side_of(item);
    if (typeof value !== 'number') return { ...rest, side };
    const turned_over = typeof offset_m !== 'number' && value > 0 && side === 'left';
    return { ...rest, offset_m: turned_over ? -value : value };
  }
  const side: Side = value === 'right' ? 'right' : 'left';
  if (typeof offset_m !== 'number') return { ...rest, side };
  return { ...rest, offset_m: side === 'right' ? Math.abs(offset_m) : -Math.abs(offset_m) };
};

/**
 * The item with one field set; null takes it out. A turn is either relative or absolute; a place is
 * latitude and longitude, or none.
 */
export const with_field = (item: Item, key: string, value: unknown): Item => {
  if (item.type === 'landmarks' && (key === 'offset_m' || key === 'side')) {
    return with_side(item, key, value);
  }
  const without_place =
    item.type === 'loiter' && value === null && (key === 'lat' || key === 'lon');
  const entries = Object.entries(item).filter(
    ([name]) => name !== key && !(without_place && (name === 'lat' || name === 'lon')),
  );
  const rest =
    item.type === 'turn' && value !== null && key !== 'radius_m'
      ? entries.filter(([name]) => name !== 'turn_deg' && name !== 'heading_deg')
      : entries;
  if (value !== null && value !== undefined) rest.push([key, value]);
  return Object.fromEntries(rest) as unknown as Item;
};

export const field_value = (item: Item, key: string): unknown =>
  item.type === 'landmarks' && key === 'side'
    ? side_of(item)
    : (item as unknown as Record<string, unknown>)[key];
