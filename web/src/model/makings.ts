// What missions were made of: the field or the block of rows that was drawn stays one object, and its
// points follow when it is changed later. The robot keeps it with the mission, so that another device can
// go on drawing; what was drawn before it did, or was too large for it, is kept on the device.

import { is_list_of, is_place, is_record, json_of } from './checked';
import { words_of } from './compare';
import type { LineOnMap } from './on_map';
import type { Item, KeptDrawing, LatLon, Plan } from './plan';
import { drawn_block, row_length_m, type RowsWish } from './row_block';
import type { SurveyWish } from './survey';

/** Two places: where row 1 begins and ends; none: where the robot stands. */
export interface DrawnRows {
  readonly kind: 'rows';
  readonly wish: RowsWish;
  readonly places: readonly LatLon[];
}
export interface DrawnField {
  readonly kind: 'survey';
  readonly wish: SurveyWish;
}
export type Drawn = DrawnRows | DrawnField;

/** In one order, and without what says nothing: as the robot keeps it, or as it is on the screen. */
const in_order = (value: unknown): unknown => {
  if (Array.isArray(value)) return value.map(in_order);
  if (!is_record(value)) return value;
  const said = Object.entries(value).filter(([, each]) => each !== null && each !== undefined);
  return said.sort(([a], [b]) => (a < b ? -1 : 1)).map(([key, each]) => [key, in_order(each)]);
};

export const same_drawn = (a: Drawn, b: Drawn): boolean => {
  const words = ({ kind, wish, ...rest }: Drawn): string =>
    JSON.stringify(in_order([kind, wish, 'places' in rest ? rest.places : null]));
  return words(a) === words(b);
};

export interface Making {
  /** The mission. */
  readonly id: string;
  /** Of the items that came of it. */
  readonly mark: string;
  readonly drawn: Drawn;
}

const PRIME = 0x01000193;
/** Items never change, and one plan has most of those of the one before it. */
const known = new WeakMap<Item, number>();

/** FNV-1a. */
const hash_of = (item: Item): number => {
  const before = known.get(item);
  if (before !== undefined) return before;
  let hash = 0x811c9dc5;
  for (const letter of words_of(item)) {
    hash = Math.imul(hash ^ (letter.codePointAt(0) ?? 0), PRIME) >>> 0;
  }
  known.set(item, hash);
  return hash;
};

/** The same for the same items, in whatever order their fields stand. */
export const mark_of = (items: readonly Item[]): string => {
  const hash = items.reduce((sum, item) => Math.imul(sum ^ hash_of(item), PRIME) >>> 0, 1);
  return `${items.length}-${hash.toString(16)}`;
};

const MAKINGS_MOST = 60;
/** Of one mission: so that undone and done again it is still what it was made of. */
const OF_ONE_MOST = 10;

/** Newest first. */
export const with_making = (makings: readonly Making[], made: Making): readonly Making[] => {
  let of_it = 0;
  return [made, ...makings.filter(({ id, mark }) => id !== made.id || mark !== made.mark)]
    .filter(({ id }) => id !== made.id || (of_it += 1) <= OF_ONE_MOST)
    .slice(0, MAKINGS_MOST);
};

export interface Found {
  readonly drawn: Drawn;
  /** Points of it were changed by hand since. */
  readonly by_hand: boolean;
}

/** @param items of the mission as it is now @return null: it was made otherwise, or elsewhere */
export const making_of = (
  makings: readonly Making[],
  id: string,
  items: readonly Item[],
): Found | null => {
  const own = makings.filter((made) => made.id === id);
  const [newest] = own;
  if (!newest) return null;
  const mark = mark_of(items);
  const same = own.find((made) => made.mark === mark);
  return { drawn: (same ?? newest).drawn, by_hand: same === undefined };
};

/** As many letters does the robot keep; with some left for what takes more than a byte. */
const KEPT_LETTERS = 48_000;

/** For the robot to keep. @return null: it is too large */
export const drawing_of = (drawn: Drawn, items: readonly Item[]): KeptDrawing | null => {
  const drawing = { ...drawn, mark: mark_of(items) };
  return JSON.stringify(drawing).length <= KEPT_LETTERS ? drawing : null;
};

const is_ring = (value: unknown): value is readonly LatLon[] => is_list_of(value, is_place);

const is_entry = (value: unknown): boolean =>
  value === null ||
  (is_record(value) && is_place(value['at']) && typeof value['heading_deg'] === 'number');

const is_drawn = (value: unknown): value is Drawn => {
  if (!is_record(value) || !is_record(value['wish'])) return false;
  const { kind, wish, places } = value;
  if (typeof wish['spacing_m'] !== 'number') return false;
  if (kind === 'survey') return is_ring(wish['polygon']) && is_list_of(wish['holes'], is_ring);
  return (
    kind === 'rows' &&
    typeof wish['rows'] === 'number' &&
    is_entry(wish['entry']) &&
    is_ring(places)
  );
};

/** What the robot kept. @return null: nothing, or nothing that this page draws */
export const drawing_in = ({ drawing, items }: Plan): Found | null =>
  is_drawn(drawing) ? { drawn: drawing, by_hand: drawing['mark'] !== mark_of(items) } : null;

const is_making = (value: unknown): value is Making =>
  is_record(value) &&
  typeof value['id'] === 'string' &&
  typeof value['mark'] === 'string' &&
  is_drawn(value['drawn']);

export const parse_makings = (text: string | null): readonly Making[] => {
  const value = json_of(text);
  return Array.isArray(value) ? value.filter(is_making) : [];
};

/** Beside the mission's own points: the field's border and its obstacles; of rows, which have no points,
 * the way through them. */
export const drawn_on_map = (drawn: Drawn, items: readonly Item[]): readonly LineOnMap[] => {
  if (drawn.kind === 'survey') {
    const { polygon, holes } = drawn.wish;
    return [polygon, ...holes].map((ring): LineOnMap => ({
      places: [...ring, ...ring.slice(0, 1)],
      tone: 'drawn',
    }));
  }
  const { entry } = drawn.wish;
  if (!entry) return [];
  return [
    {
      places: drawn_block(items, entry, row_length_m(drawn.wish.distance_m, drawn.places)).way,
      tone: 'drawn',
    },
  ];
};
