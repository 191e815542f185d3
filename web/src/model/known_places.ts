// Tags, poles and cones whose place people entered, and what became of them when they were seen.

import type { Answer } from './answer';
import { age, direction, metres, UNKNOWN } from './format';
import type { GraphOnMap } from './node_graph';
import type { LatLon } from './plan';
import { say, told } from './say';
import type { Slip } from './slips';

export interface KnownPlace extends LatLon {
  readonly name: string;
  /** Its AprilTag's number; null: a pole or a cone. */
  readonly tag: number | null;
  /** In which the tag looks, out of its wall. */
  readonly heading_deg: number | null;
  readonly accuracy_m: number;
  readonly heading_accuracy_deg: number;
  /** By the configuration: it is changed there. */
  readonly configured: boolean;
  readonly state: 'unseen' | 'used' | 'agrees' | 'contradicts' | 'disputed' | 'ambiguous';
  /** Where it was seen last, from where it was entered. */
  readonly off_m: number | null;
  readonly off_direction_deg: number | null;
  readonly sigma_m: number | null;
  readonly detail: string | null;
  readonly age_s: number | null;
}

export interface NewKnownPlace extends LatLon {
  readonly tag: number | null;
  readonly heading_deg: number | null;
  readonly accuracy_m: number | null;
}

export interface KnownPlaceCalls {
  all(): Promise<Answer<readonly KnownPlace[]>>;
  enter(name: string, place: NewKnownPlace): Promise<Answer<KnownPlace>>;
  forget(name: string): Promise<Answer<unknown>>;
}

/** Places that are kept for good, as the map shows them. */
export interface KeptPlaces {
  readonly slips: readonly Slip[];
  readonly known: readonly KnownPlace[];
  /** Along which ways are planned; null: none is looked at. */
  readonly graph: GraphOnMap | null;
}

/** AprilTags of tag36h11. */
export const MOST_TAG = 586;

export const known_tone = ({ state }: KnownPlace): 'good' | 'bad' | 'none' =>
  state === 'unseen' ? 'none' : state === 'used' || state === 'agrees' ? 'good' : 'bad';

export const known_states: Readonly<Record<KnownPlace['state'], string>> = told({
  unseen: 'known_unseen',
  used: 'known_used',
  agrees: 'known_agrees',
  contradicts: 'known_contradicts',
  disputed: 'known_disputed',
  ambiguous: 'known_ambiguous',
});

/** "Tag 12", "Pole or cone". */
export const known_kind = (tag: number | null): string =>
  tag === null ? say('pole_or_cone') : say('tag_number', { tag });

/** How far from its place it was seen, to where, and how well that is known. */
export const known_off = (place: KnownPlace): string => {
  const { off_m, off_direction_deg, sigma_m } = place;
  if (off_m === null) return UNKNOWN;
  const sure = sigma_m === null ? '' : ` ±${metres(sigma_m)}`;
  return `${metres(off_m)}${sure}, ${direction(off_direction_deg)}`;
};

/** "Agrees, 3 s ago"; what was never seen has no age. */
export const known_line = (place: KnownPlace): string =>
  place.age_s === null
    ? known_states[place.state]
    : `${known_states[place.state]}, ${age(place.age_s)}`;

const NAME = /^[a-z0-9_]{1,24}$/;

/** What is typed into the form. */
export interface KnownDraft {
  readonly name: string;
  readonly kind: 'tag' | 'pole';
  readonly tag: number | null;
  readonly at: LatLon | null;
  readonly heading_deg: number | null;
  readonly accuracy_m: number | null;
}

/** @param taken names that the configuration has. @return why it cannot be entered; null: it can */
export const why_not_enter = (draft: KnownDraft, taken: readonly string[]): string | null => {
  if (!NAME.test(draft.name)) return say('known_name_of_letters');
  if (taken.includes(draft.name)) return say('known_by_the_configuration');
  if (draft.kind === 'tag' && draft.tag === null) return say('known_tag_needs_a_number');
  if (draft.at === null) return say('type_a_place_first');
  return null;
};

/** A pole looks nowhere. */
export const new_known = (draft: KnownDraft & { readonly at: LatLon }): NewKnownPlace => ({
  tag: draft.kind === 'tag' ? draft.tag : null,
  lat: draft.at.lat,
  lon: draft.at.lon,
  heading_deg: draft.kind === 'tag' ? draft.heading_deg : null,
  accuracy_m: draft.accuracy_m,
});
