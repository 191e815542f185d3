// Maps of a place in the plane: where their cells lie on the earth, what a hand changes in them, and
// the words for whether the robot knows its place in the one that is in use.

import { robot } from '../texts/en/robot';
import { robot_says } from './robot_words';
import type { SiteCells } from './site_cells';
import type { Answer } from './answer';
import { accuracy, count, degrees_text, metres, sentence } from './format';
import { offset_between, offset_from } from './geo';
import type { Places } from './outline';
import type { LatLon } from './plan';
import { say, told } from './say';
import type { Placed } from './seen';

/** In the map's own frame. */
export interface MapPoint {
  readonly x_m: number;
  readonly y_m: number;
}
/** Where x = y = 0 lies and which way the x axis looks; and how well that is known, 1 sigma. */
export interface MapAnchor extends Placed {
  readonly accuracy_m: number;
  readonly heading_accuracy_deg: number;
}
export interface SiteMap {
  /** 0: the one that the configuration names, which stays as it is. */
  readonly id: number;
  readonly name: string;
  /** Another one with every change. */
  readonly revision: number;
  /** Null: not known. */
  readonly created_at: string | null;
  /** Cells. */
  readonly width: number;
  readonly height: number;
  readonly resolution_m: number;
  /** The lower left corner of the picture, and how the picture is turned about it. */
  readonly origin: MapPoint & { readonly yaw_deg: number };
  /** As it was told; null: nobody knows. */
  readonly anchor: MapAnchor | null;
  /** Likewise, as the robot drives by it now; null: not in use, or not known. */
  readonly placed?: MapAnchor | null;
  readonly in_use: boolean;
  readonly size_bytes: number;
  /** It has a third dimension: a .pcd. */
  readonly solid: boolean;
  /** Why it cannot be used; null: it can. */
  readonly problem: string | null;
  /** Areas where nobody shall drive; only where one map is asked for. */
  readonly forbidden?: readonly (readonly MapPoint[])[];
  /** Of one that was just sent: what of its files is not in it. */
  readonly passed_over?: readonly string[];
}
/** A map that is being driven. */
export interface SiteMaking {
  /** Taken so far; who stands adds none. */
  readonly scans: number;
  /** Of a lidar of several rows: from five on it will have a third dimension. */
  readonly clouds: number;
  readonly way_m: number;
  /** What is wrong; null: it goes on. */
  readonly trouble: string | null;
}
export interface SiteMapList {
  readonly items: readonly SiteMap[];
  readonly in_use: number | null;
  readonly making: SiteMaking | null;
}

export type EditKind = 'erase' | 'forbid' | 'wall';
/** What is drawn: all cells within become free, forbidden or occupied. */
export interface SiteEdit {
  readonly kind: EditKind;
  readonly ring: Places;
}
export interface SiteChange {
  /** Refused if the map is another one by now. */
  readonly revision?: number;
  readonly name?: string;
  readonly anchor?: MapAnchor | null;
  /** Instead of those before. */
  readonly forbidden?: readonly (readonly MapPoint[])[];
  readonly edits?: readonly {
    readonly kind: EditKind;
    readonly polygon: readonly MapPoint[];
  }[];
}

export interface SiteOnMap {
  readonly map: SiteMap;
  readonly cells: SiteCells;
  readonly at: Placed;
}

export interface SiteMapCalls {
  list(): Promise<Answer<SiteMapList>>;
  read(id: number): Promise<Answer<SiteMap>>;
  /** It is called as the files say. @param sent told a share from 0 to 1 now and then */
  add(pair: MapFiles, sent: (share: number) => void): Promise<Answer<SiteMap>>;
  change(id: number, change: SiteChange): Promise<Answer<SiteMap>>;
  remove(id: number): Promise<Answer<unknown>>;
  /** @param id null: none */
  use(id: number | null): Promise<Answer<unknown>>;
  /** @param tag of what is known already; @param signal gives up. @return null: that is still so */
  cells(id: number, tag: string | null, signal: AbortSignal): Promise<Answer<TaggedCells | null>>;
  start_making(): Promise<Answer<SiteMaking>>;
  /** @param name empty: any that is free */
  finish_making(name: string): Promise<Answer<SiteMap>>;
  drop_making(): Promise<Answer<unknown>>;
  file_address(id: number, format: 'yaml' | 'pgm' | 'pcd'): string;
}
export interface TaggedCells extends SiteCells {
  readonly tag: string | null;
}
export interface SiteMapView {
  /** The cells of a map below everything else; null: none. */
  show_site(site: SiteOnMap | null): void;
  /** What is drawn of changes that are not saved. */
  show_site_edits(edits: readonly SiteEdit[]): void;
}

const RAD = Math.PI / 180;

/** Where a point of the map lies. @param at of x = y = 0, and of the x axis */
export const on_earth = (at: Placed, { x_m, y_m }: MapPoint): LatLon => {
  const [sin, cos] = [Math.sin(at.heading_deg * RAD), Math.cos(at.heading_deg * RAD)];
  return offset_from(at, { east_m: x_m * sin - y_m * cos, north_m: x_m * cos + y_m * sin });
};

/** The other way: millimetres are more than any cell. */
export const in_map = (at: Placed, place: LatLon): MapPoint => {
  const [sin, cos] = [Math.sin(at.heading_deg * RAD), Math.cos(at.heading_deg * RAD)];
  const { east_m, north_m } = offset_between(at, place);
  const rounded = (metres: number): number => Math.round(metres * 1000) / 1000 + 0; // no -0
  return {
    x_m: rounded(east_m * sin + north_m * cos),
    y_m: rounded(north_m * sin - east_m * cos),
  };
};

/** The corners of its picture, from the lower left one, to its right first. */
export const corners = (map: SiteMap, at: Placed): readonly LatLon[] => {
  const { x_m, y_m, yaw_deg } = map.origin;
  const [sin, cos] = [Math.sin(yaw_deg * RAD), Math.cos(yaw_deg * RAD)];
  const [wide, high] = [map.width * map.resolution_m, map.height * map.resolution_m];
  const corner = (u: number, v: number): LatLon =>
    on_earth(at, { x_m: x_m + u * cos - v * sin, y_m: y_m + u * sin + v * cos });
  return [corner(0, 0), corner(wide, 0), corner(wide, high), corner(0, high)];
};

/** Where a map is drawn: as the robot drives by it, else where it was told to lie, else here. */
export const place_of_map = (map: SiteMap, here: LatLon | null): Placed | null =>
  map.placed ?? map.anchor ?? (here && { lat: here.lat, lon: here.lon, heading_deg: 90 });

/** Nobody knows where it lies: where it is drawn means nothing. */
export const lies_anywhere = (map: SiteMap): boolean => !map.placed && !map.anchor;

/** By the fields of the form in which they are sent. */
export type MapFiles = { readonly yaml: File; readonly image: File } | { readonly cloud: File };

const endings = /\.(ya?ml|pgm|png|pcd)$/i;

/** As the map is called. */
export const name_of_files = (files: MapFiles): string =>
  ('cloud' in files ? files.cloud : files.yaml).name.replace(endings, '');

/** The files of one map, of those that were picked. @return what is wrong with them, in words */
export const pair_of = (files: readonly File[]): MapFiles | string => {
  const cloud = files.find(({ name }) => /\.pcd$/i.test(name));
  if (cloud && files.length === 1) return { cloud };
  const [yamls, images] = [/\.ya?ml$/i, /\.(pgm|png)$/i].map((ending) =>
    files.filter(({ name }) => ending.test(name)),
  );
  const [yaml, image] = [yamls?.[0], images?.[0]];
  const other = files.find(({ name }) => !endings.test(name));
  if (other) return say('name_is_no_part_of_a_map_pick_its', { name: other.name });
  if (cloud) return say('one_map_at_a_time_pick_one_yaml_and');
  if (!yaml && !image) return say('pick_the_yaml_and_the_pgm_of_a_map');
  if (!yaml) return say('the_yaml_is_missing_pick_both_files');
  if (!image) return say('the_pgm_is_missing_pick_both_files');
  if (files.length > 2) return say('one_map_at_a_time_pick_one_yaml_and');
  return { yaml, image };
};

export const edit_words: Record<EditKind, string> = told({
  erase: 'erase',
  forbid: 'forbid',
  wall: 'wall',
});
export const edit_meaning: Record<EditKind, string> = told({
  erase: 'what_is_drawn_there_goes_people_and',
  forbid: 'nobody_shall_drive_there_although',
  wall: 'something_stands_there_that_the_map',
});

/** What will be saved together. */
export interface SiteDraft {
  readonly edits: readonly SiteEdit[];
  /** Of the areas that are forbidden already, those that stay so. */
  readonly forbidden: readonly (readonly MapPoint[])[];
}
type Act = (draft: SiteDraft) => SiteDraft;

export const add_edit =
  (kind: EditKind): Act =>
  (draft) => ({ ...draft, edits: [...draft.edits, { kind, ring: [] }] });

export const remove_edit =
  (index: number): Act =>
  (draft) =>
    draft.edits[index] ? { ...draft, edits: draft.edits.filter((_, k) => k !== index) } : draft;

export const change_ring =
  (index: number, action: (ring: Places) => Places): Act =>
  (draft) => ({
    ...draft,
    edits: draft.edits.map((edit, k) =>
      k === index ? { ...edit, ring: action(edit.ring) } : edit,
    ),
  });

/** What was forbidden is so no more. */
export const allow =
  (index: number): Act =>
  (draft) => ({ ...draft, forbidden: draft.forbidden.filter((_, k) => k !== index) });

const allows = ({ forbidden }: SiteDraft, before: SiteMap): boolean =>
  forbidden.length !== (before.forbidden?.length ?? 0);

export const changes_map = (draft: SiteDraft, before: SiteMap): boolean =>
  draft.edits.length > 0 || allows(draft, before);

/** Why it cannot be saved yet. */
export const why_not_save = (draft: SiteDraft, before: SiteMap): string | null => {
  if (!changes_map(draft, before)) return say('nothing_is_drawn');
  const poor = draft.edits.findIndex(({ ring }) => ring.length < 3);
  return poor < 0 ? null : say('area_poor_needs_three_corners', { poor: poor + 1 });
};

/** What another one forbade meanwhile must not be allowed unseen: the revision says what was seen.
 * @param at where the map was drawn while one drew on it */
export const change_of = (draft: SiteDraft, before: SiteMap, at: Placed): SiteChange => ({
  ...(allows(draft, before) ? { revision: before.revision, forbidden: draft.forbidden } : {}),
  edits: draft.edits.map(({ kind, ring }) => ({ kind, polygon: ring.map((p) => in_map(at, p)) })),
});

/** "A map is being made: 12 m driven, 87 scans, 11 clouds for its heights." */
export const made_so_far = ({ scans, clouds, way_m }: SiteMaking): string => {
  const plane = { way: metres(way_m), scans: count(scans, 'scan') };
  return clouds === 0
    ? say('a_map_is_being_made_way_driven_scans', plane)
    : say('a_map_is_being_made_with_clouds', { ...plane, clouds: count(clouds, 'cloud') });
};

/** Whether the robot knows where it is in the map, as the interface tells it. */
export interface MapPlace {
  readonly state: 'off' | 'lost' | 'searching' | 'known';
  /** Its name; null: none is in use. */
  readonly map: string | null;
  readonly map_id?: number | null;
  readonly reason: string | null;
  /** Null: not known. */
  readonly x_m?: number | null;
  readonly y_m?: number | null;
  readonly accuracy_m: number | null;
  readonly heading_accuracy_deg: number | null;
  readonly stale: boolean;
}

export interface PlaceWords {
  readonly tone: 'good' | 'warn' | 'bad';
  readonly head: string;
  /** How well, or what helps. */
  readonly detail: string;
}

const FINE_M = 0.3;

/** Neither anchor nor satellites, and nobody has said where the robot stands: it says itself what helps. */
const LIES_NOWHERE = [robot.rb_no_anchor, robot.rb_word_counts_once_found, robot.rb_no_tap_before];
const lies_nowhere = ({ reason }: MapPlace): boolean =>
  LIES_NOWHERE.some((words) => reason?.includes(words) ?? false);

/** "Knows its place in “hall”" · "±3 cm, ±0.4°" */
export const place_words = (place: MapPlace): PlaceWords | null => {
  const map = `“${place.map ?? ''}”`;
  const why = place.reason === null ? '' : `${sentence(robot_says(place.reason))}. `;
  switch (place.state) {
    case 'off':
      return null;
    case 'known': {
      if (place.accuracy_m === null || place.stale) {
        const now = say('what_it_sees_does_not_fit_just_now');
        const head = say('not_sure_of_its_place_in_map', { map });
        return { tone: 'warn', head, detail: why === '' ? now : why.trim() };
      }
      if (lies_nowhere(place)) {
        return { tone: 'warn', head: say('knows_its_place_in_map', { map }), detail: why.trim() };
      }
      const head = say('knows_its_place_in_map', { map });
      const turned = place.heading_accuracy_deg;
      const angle = turned === null ? '' : `, ±${degrees_text(turned)}`;
      const fine = place.accuracy_m <= FINE_M;
      const alike = fine ? '' : say('along_what_it_sees_every_place_looks');
      const detail = `${accuracy(place.accuracy_m)}${angle}.${alike} ${why}`.trim();
      return { tone: fine ? 'good' : 'warn', head, detail };
    }
    case 'searching':
      return {
        tone: 'warn',
        head: say('looks_for_its_place_in_map', { map }),
        detail: lies_nowhere(place)
          ? why.trim()
          : say('why_drive_some_metres_by_hand_or_say', { why }),
      };
    case 'lost':
      return {
        tone: 'bad',
        head: say('lost_in_map', { map }),
        detail: say('why_drive_by_hand_to_a_place_that_it', { why }),
      };
  }
};

/** A scan that fits is seen within a second or two. */
const LONG_S = 5;

/** Where the robot stands, as a person says it. */
export interface StandingPose extends LatLon {
  /** Left out: it looks all ways. */
  readonly heading_deg?: number;
}

/** A person shows a place no better. */
const THERE_M = 2;

/** What became of “I am here”, so long after it was taken.
 * @param off_m where it takes itself to stand, from what was told; null: it does not know
 * @return null: wait and see */
export const seen_since = (
  place: MapPlace,
  after_s: number,
  off_m: number | null,
): PlaceWords | null => {
  if (place.state === 'searching' && lies_nowhere(place)) {
    const detail = `${sentence(robot_says(place.reason ?? ''))}.`;
    return { tone: 'warn', head: say('it_is_heard_and_the_map_lies_nowhere'), detail };
  }
  if (place.state === 'known' && place.accuracy_m !== null && !place.stale && off_m !== null) {
    if (off_m > THERE_M) {
      if (after_s < LONG_S) return null;
      const detail = say('by_what_it_sees_it_stands_off_from', { off: metres(off_m) });
      return { tone: 'warn', head: say('it_knows_its_place_elsewhere'), detail };
    }
    const detail = say('what_it_sees_fits_there_to_accuracy', {
      accuracy: accuracy(place.accuracy_m),
    });
    return { tone: 'good', head: say('it_is_there'), detail };
  }
  if (after_s < LONG_S) return null;
  const detail = say('drive_a_metre_or_two_by_hand_or_show');
  return { tone: 'warn', head: say('what_it_sees_does_not_fit_there_yet'), detail };
};
