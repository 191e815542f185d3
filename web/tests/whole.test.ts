import { describe, expect, it } from 'vitest';

import type { DrawnRows } from '../src/model/makings';
import type { LatLon } from '../src/model/plan';
import type { Station } from '../src/ui/station.svelte';
import { whole_of } from '../src/ui/whole';

const begins: LatLon = { lat: 58, lon: 26 };
const ends: LatLon = { lat: 58.001, lon: 26 };
const way: readonly LatLon[] = [begins, { lat: 58.1, lon: 26.1 }];
const rows: DrawnRows = {
  kind: 'rows',
  places: [begins, ends],
  wish: {
    ...{ rows: 1, spacing_m: 2.5, turn: 'right', skip: 0, out_m: 1.5, side: 'both' },
    entry: { at: begins, heading_deg: 0 },
    ...{ gap_m: null, speed_mps: null, distance_m: null, seeing: 'line' },
  },
};
const station = (by_hand: boolean, told: readonly LatLon[] = []): Station =>
  ({
    dialogs: { open: told.length > 0 ? { kind: 'report', report: { places: told } } : null },
    editor: {
      plan: { name: 'Rows', items: [{ type: 'waypoint', ...begins }, { type: 'row' }] },
    },
    makings: { here: { drawn: rows, by_hand } },
    route: { plan: null },
    live: { places: way },
  }) as unknown as Station;
const farthest = (places: readonly LatLon[]): number => Math.max(...places.map(({ lat }) => lat));

describe('the whole', () => {
  it('is the rows as they were drawn, though the mission has a place for their beginning alone', () => {
    expect(farthest(whole_of(station(false)))).toBeCloseTo(ends.lat, 5);
    // Changed by hand, they are no longer those that were drawn.
    expect(whole_of(station(true))).toMatchObject([begins]);
  });

  it('is what a report tells of, as long as one is open', () => {
    expect(whole_of(station(false, way))).toEqual(way);
  });
});
