// The fields of every kind of item: label, unit, range. One table makes the editor, reads what was
// typed and names what is wrong. The server checks again.

import type { Item, ItemType, LatLon } from './plan';

export interface NumberField {
  readonly kind: 'number';
  readonly key: string;
  readonly label: string;
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
  readonly label: string;
  readonly choices: readonly (readonly [value: string, label: string])[];
}
export interface TextField {
  readonly kind: 'text';
  readonly key: string;
  readonly label: string;
}
export interface FlagField {
  readonly kind: 'flag';
  readonly key: string;
  readonly label: string;
}
export type Field = NumberField | ChoiceField | TextField | FlagField;

type Range = readonly [min: number, max: number];

const must = (key: string, label: string, unit: string, [min, max]: Range): NumberField => ({
  kind: 'number',
  key,
  label,
  unit,
  min,
  max,
  optional: false,
});
const may = (key: string, label: string, unit: string, range: Range): NumberField => ({
  ...must(key, label, unit, range),
  optional: true,
});
const whole = (field: NumberField): NumberField => ({ ...field, whole: true });

const SIDE: ChoiceField = {
  kind: 'choice',
  key: 'side',
  label: 'Side',
  choices: [
    ['left', 'Left'],
    ['right', 'Right'],
  ],
};
const ROW_SIDE: ChoiceField = { ...SIDE, choices: [['both', 'Both: the middle'], ...SIDE.choices] };
const SEEING: ChoiceField = {
  kind: 'choice',
  key: 'seeing',
  label: 'Seen by',
  choices: [
    ['line', 'Lines'],
    ['rays', 'Outermost rays'],
  ],
};
const TURN: ChoiceField = {
  kind: 'choice',
  key: 'turn',
  label: 'Turn style',
  choices: [
    ['auto', 'Automatic'],
    ['pivot', 'On the spot'],
    ['arc', 'Arc'],
    ['through', 'Drive through'],
  ],
};
const FAR: Range = [-10_000, 10_000];

export const fields_of: Record<ItemType, readonly Field[]> = {
  waypoint: [
    must('lat', 'Latitude', '°', [-90, 90]),
    must('lon', 'Longitude', '°', [-180, 180]),
    may('speed_mps', 'Speed', 'm/s', [0.01, 10]),
    may('hold_s', 'Hold', 's', [0, 86_400]),
    may('radius_m', 'Radius', 'm', [0.01, 100]),
    TURN,
    { kind: 'flag', key: 'reverse', label: 'Drive backwards' },
  ],
  local: [
    must('east_m', 'East', 'm', FAR),
    must('north_m', 'North', 'm', FAR),
    may('heading_deg', 'Heading', '°', [0, 360]),
  ],
  move: [must('forward_m', 'Forward', 'm', FAR)],
  turn: [
    may('turn_deg', 'Turn by', '°', [-3600, 3600]),
    may('heading_deg', 'Turn to heading', '°', [0, 360]),
  ],
  wait: [must('seconds', 'Wait', 's', [0, 86_400])],
  speed: [must('speed_mps', 'Speed', 'm/s', [0.01, 10])],
  row: [
    ROW_SIDE,
    may('gap_m', 'Gap, along one side', 'm', [0.01, 20]),
    may('speed_mps', 'Speed', 'm/s', [0.01, 10]),
    may('distance_m', 'Ends after', 'm', [0.01, 10_000]),
    SEEING,
  ],
  wall: [
    SIDE,
    must('distance_m', 'Distance', 'm', [0.01, 20]),
    may('speed_mps', 'Speed', 'm/s', [0.01, 10]),
    may('length_m', 'Ends after', 'm', [0.01, 10_000]),
  ],
  landmarks: [
    { kind: 'text', key: 'name', label: 'Name' },
    must('offset_m', 'Offset', 'm', [-20, 20]),
    may('speed_mps', 'Speed', 'm/s', [0.01, 10]),
    whole(may('count', 'Ends after', '', [0, 10_000])),
  ],
  jump: [
    whole(must('item', 'To item', '', [1, 1_000_000])),
    whole(must('times', 'Times (0: for ever)', '', [0, 1_000_000])),
  ],
  return_home: [],
  action: [{ kind: 'text', key: 'name', label: 'Name' }],
  loiter: [
    may('lat', 'Latitude', '°', [-90, 90]),
    may('lon', 'Longitude', '°', [-180, 180]),
    may('seconds', 'Stay', 's', [0, 86_400]),
    may('radius_m', 'Back beyond', 'm', [0.1, 100]),
  ],
  circle: [
    must('lat', 'Latitude', '°', [-90, 90]),
    must('lon', 'Longitude', '°', [-180, 180]),
    must('radius_m', 'Radius', 'm', [0.5, 1000]),
    may('turns', 'Turns', '', [0.05, 1000]),
    may('speed_mps', 'Speed', 'm/s', [0.01, 10]),
    whole(may('stations', 'Looks in, a turn', '', [0, 36])),
    may('hold_s', 'Hold there', 's', [0, 86_400]),
    { kind: 'flag', key: 'clockwise', label: 'Clockwise' },
  ],
};

/** A new item of a kind, with sensible values. Waypoints are made on the map. */
export const fresh_item = (type: Exclude<ItemType, 'waypoint'>, near: LatLon | null): Item => {
  switch (type) {
    case 'local':
      return { type, east_m: 0, north_m: 0 };
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
      return { type, side: 'left', distance_m: 0.9 };
    case 'landmarks':
      return { type, name: 'cone', offset_m: 0.7 };
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

export const type_words: Record<ItemType, string> = {
  waypoint: 'Waypoint',
  local: 'Local point',
  move: 'Move straight',
  turn: 'Turn',
  wait: 'Wait',
  speed: 'Change speed',
  row: 'Follow row',
  wall: 'Follow wall',
  landmarks: 'Follow landmarks',
  jump: 'Jump',
  return_home: 'Return home',
  action: 'Action',
  loiter: 'Stay at a place',
  circle: 'Circle',
};

export type Read =
  | { readonly ok: true; readonly value: number | null }
  | { readonly ok: false; readonly error: string };

/** Reads what a person typed; a comma counts as a decimal point. */
export const read_number = (field: NumberField, text: string): Read => {
  const typed = text.trim().replace(',', '.').replace('−', '-');
  if (typed === '') {
    return field.optional
      ? { ok: true, value: null }
      : { ok: false, error: `${field.label} is needed.` };
  }
  const value = Number(typed);
  if (!Number.isFinite(value)) return { ok: false, error: `${field.label} must be a number.` };
  if (field.whole === true && !Number.isInteger(value)) {
    return { ok: false, error: `${field.label} must be a whole number.` };
  }
  if (value < field.min || value > field.max) {
    return { ok: false, error: `${field.label} must be from ${field.min} to ${field.max}.` };
  }
  return { ok: true, value };
};

/**
 * The item with one field set; null takes it out. A turn is either relative or absolute; a place is
 * latitude and longitude, or none.
 */
export const with_field = (item: Item, key: string, value: unknown): Item => {
  const without_place =
    item.type === 'loiter' && value === null && (key === 'lat' || key === 'lon');
  const entries = Object.entries(item).filter(
    ([name]) => name !== key && !(without_place && (name === 'lat' || name === 'lon')),
  );
  const rest =
    item.type === 'turn' && value !== null
      ? entries.filter(([name]) => name !== 'turn_deg' && name !== 'heading_deg')
      : entries;
  if (value !== null && value !== undefined) rest.push([key, value]);
  return Object.fromEntries(rest) as unknown as Item;
};

export const field_value = (item: Item, key: string): unknown =>
  (item as unknown as Record<string, unknown>)[key];
