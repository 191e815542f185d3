// An import's report as a map: where each row of the file lies, and what became of it.

import type { PlacesOfRow } from './file_places';
import type { LineOnMap, PointMark } from './on_map';
import { place_of, type LatLon, type Plan } from './plan';
import type { ImportEntry } from './ports';

export interface LocatedEntry {
  readonly entry: ImportEntry;
  /** Its own, or of its area the corners; none: nothing tells where it lies. */
  readonly places: readonly LatLon[];
  /** It has none of its own: it would come after what lies there. */
  readonly behind: boolean;
}

/** The list of the file that holds it: what follows on another list is not driven after it. */
const list_of = (row: string): string => row.replace(/\/?\d+$|\d+$/, '');

/**
 * @param plan_of missions of the file by their numbers, from 1; undefined: it is not in hand
 * @param places_of what the file itself says
 */
export const located = (
  report: readonly ImportEntry[],
  plan_of: (mission: number) => Plan | undefined,
  places_of: PlacesOfRow,
): readonly LocatedEntry[] => {
  let last: { readonly list: string; readonly at: LatLon } | null = null;
  return report.map((entry): LocatedEntry => {
    const item =
      entry.item === null ? undefined : plan_of(entry.mission ?? 1)?.items[entry.item - 1];
    const own = item ? place_of(item) : null;
    const places = own ? [own] : places_of(entry.row);
    const list = list_of(entry.row);
    const [at] = places;
    if (at) {
      if (places.length === 1) last = { list, at };
      return { entry, places, behind: false };
    }
    // An area that was taken is nothing to come after a point.
    const would_come = entry.item !== null || entry.outcome !== 'taken';
    return would_come && last?.list === list
      ? { entry, places: [last.at], behind: true }
      : { entry, places: [], behind: false };
  });
};

/** What a row is seen with: its own places, and the nearest before and behind it in the file that have
 * one. @return empty: it has none itself */
export const in_context = (entries: readonly LocatedEntry[], k: number): readonly LatLon[] => {
  const own = entries[k]?.places ?? [];
  if (own.length !== 1) return own;
  const has_place = ({ places }: LocatedEntry): boolean => places.length === 1;
  const before = entries.slice(0, k).findLast(has_place);
  const behind = entries.slice(k + 1).find(has_place);
  return [...own, ...(before?.places ?? []), ...(behind?.places ?? [])];
};

/** With more of them there would be nothing to see but rings. */
const MARKS_MOST = 2000;

const marks = (
  entries: readonly LocatedEntry[],
  outcome: ImportEntry['outcome'],
): readonly LineOnMap[] => {
  const of = entries.filter(({ entry, places }) => entry.outcome === outcome && places.length > 0);
  const single = (behind: boolean): LatLon[] =>
    of
      .filter((each) => each.places.length === 1 && each.behind === behind)
      .slice(0, MARKS_MOST)
      .flatMap(({ places }) => places);
  const areas = of
    .filter(({ places }) => places.length > 1)
    .map(({ places }): LineOnMap => ({ places, tone: outcome }));
  const own_mark: PointMark = outcome === 'left_out' ? 'cross' : 'ring';
  const points: readonly LineOnMap[] = [
    { places: single(false), tone: outcome, points: own_mark },
    { places: single(true), tone: outcome, points: 'around' },
  ];
  return [...areas, ...points.filter(({ places }) => places.length > 0)];
};

/** What was taken into the mission that is shown is seen as its items. @param looked at now */
export const import_on_map = (
  entries: readonly LocatedEntry[],
  looked: LocatedEntry | null,
): readonly LineOnMap[] => {
  const beside_plan = entries.filter(
    ({ entry }) => entry.outcome !== 'taken' || entry.item === null || (entry.mission ?? 1) !== 1,
  );
  const all = (['taken', 'changed', 'left_out'] as const).flatMap((outcome) =>
    marks(beside_plan, outcome),
  );
  if (!looked || looked.places.length === 0) return all;
  return [...all, { places: looked.places, tone: 'looked', points: 'around' }];
};
