import { describe, expect, it } from 'vitest';

import { places_in_file } from '../src/model/file_places';
import { import_on_map, in_context, located } from '../src/model/import_map';
import type { Plan } from '../src/model/plan';
import type { ImportEntry } from '../src/model/ports';

const row = (at: string, outcome: ImportEntry['outcome'], item: number | null): ImportEntry => ({
  row: at,
  what: 'NAV_WAYPOINT (16)',
  outcome,
  item,
  mission: item === null ? null : 1,
  reason: '',
});

describe('where a row lies, by the file itself', () => {
  it('is told by columns 9 and 10 of a waypoint file', () => {
    const place = places_in_file(
      'QGC WPL 110\r\n0\t1\t0\t16\t0\t0\t0\t0\t58.38\t26.72\t0\t1\r\n1\t0\t3\t201\t0\t0\t0\t0\t0\t0\t0\t1',
      'waypoints',
    );
    expect(place('line 2')).toEqual([{ lat: 58.38, lon: 26.72 }]);
    expect(place('line 3')).toEqual([]); // 0/0: where the vehicle is
    expect(place('line 1')).toEqual([]);
    expect(place('line 9')).toEqual([]);
  });

  it('is told by parameters 5 and 6 of an item of a plan, a fence by its corners or centre', () => {
    const place = places_in_file(
      JSON.stringify({
        mission: { items: [{ params: [0, 0, 0, null, 58.1, 26.1, 5] }, { params: [1] }] },
        geoFence: {
          polygons: [
            {
              polygon: [
                [58, 26],
                [58, 27],
                [59, 27],
              ],
            },
          ],
          circles: [{ circle: { center: [58.5, 26.5], radius: 9 } }],
          breachReturn: [58.2, 26.2, 0],
        },
      }),
      'plan',
    );
    expect(place('/mission/items/0')).toEqual([{ lat: 58.1, lon: 26.1 }]);
    expect(place('/mission/items/1')).toEqual([]);
    expect(place('/geoFence/polygons/0')).toHaveLength(3);
    expect(place('/geoFence/circles/0')).toEqual([{ lat: 58.5, lon: 26.5 }]);
    expect(place('/geoFence/breachReturn')).toEqual([{ lat: 58.2, lon: 26.2 }]);
  });

  it('has longitude first in GeoJSON and KML, and names in GPX', () => {
    const feature = {
      geometry: {
        type: 'LineString',
        coordinates: [
          [26, 58],
          [27, 59],
        ],
      },
    };
    const geo = places_in_file(JSON.stringify({ features: [feature] }), 'geojson');
    expect(geo('/features/0')).toEqual([
      { lat: 58, lon: 26 },
      { lat: 59, lon: 27 },
    ]);
    expect(geo('/features/0/geometry/coordinates/1')).toEqual([{ lat: 59, lon: 27 }]);
    const kml = places_in_file('<Point><coordinates>26.5,58.5,0</coordinates></Point>', 'kml');
    expect(kml('line 1')).toEqual([{ lat: 58.5, lon: 26.5 }]);
    const gpx = places_in_file(`<wpt lon="26.5" lat='58.5'/>`, 'gpx');
    expect(gpx('line 1')).toEqual([{ lat: 58.5, lon: 26.5 }]);
  });

  it('is not guessed: two on a line, a broken file, an impossible place', () => {
    const two = '<trkpt lat="58" lon="26"/><trkpt lat="59" lon="26"/>';
    expect(places_in_file(two, 'gpx')('line 1')).toEqual([]);
    expect(places_in_file('26,58 27,59', 'kml')('line 1')).toEqual([]);
    expect(places_in_file('{', 'plan')('/mission/items/0')).toEqual([]);
    expect(places_in_file('{"a": [91, 0]}', 'plan')('/a')).toEqual([]);
    expect(places_in_file('58,26', 'csv')('line 1')).toEqual([]);
  });
});

describe('the map of an import', () => {
  const plan: Plan = {
    name: 'A',
    items: [
      { type: 'waypoint', lat: 58, lon: 26 },
      { type: 'wait', seconds: 3 },
      { type: 'waypoint', lat: 58.001, lon: 26 },
    ],
  };
  const report = [
    row('line 2', 'taken', 1),
    row('line 3', 'changed', 2),
    row('line 4', 'left_out', null),
    row('line 5', 'changed', 3),
    row('line 6', 'left_out', null),
    row('/home', 'left_out', null),
  ];
  const rows = located(
    report,
    (mission) => (mission === 1 ? plan : undefined),
    (at) => (at === 'line 6' ? [{ lat: 58.002, lon: 26 }] : []),
  );

  it('has each row at its item, at what the file says, or behind what was before it', () => {
    expect(rows.map(({ places, behind }) => [places[0]?.lat, behind])).toEqual([
      [58, false],
      [58, true],
      [58, true],
      [58.001, false],
      [58.002, false],
      [undefined, false],
    ]);
  });

  it('has no place for an area that was taken: it does not come after a point', () => {
    const point = { lat: 58, lon: 26 };
    const [, area] = located(
      [row('line 5', 'taken', 1), row('line 6', 'taken', null)],
      () => ({ name: 'A', items: [{ type: 'waypoint', ...point }] }),
      () => [],
    );
    expect(area).toMatchObject({ places: [], behind: false });
  });

  it('shows a row together with what lies before and behind it', () => {
    expect(in_context(rows, 3).map(({ lat }) => lat)).toEqual([58.001, 58, 58.002]);
    expect(in_context(rows, 0).map(({ lat }) => lat)).toEqual([58, 58]);
    expect(in_context(rows, 5)).toEqual([]);
  });

  it('marks what was changed and left out, each in its way; the taken are the mission itself', () => {
    const marks = import_on_map(rows, null);
    const told = marks.map(({ tone, points, places }) => [tone, points, places[0]?.lat]);
    expect(told).toEqual([
      ['changed', 'ring', 58.001],
      ['changed', 'around', 58],
      ['left_out', 'cross', 58.002],
      ['left_out', 'around', 58],
    ]);
  });

  it('marks what is looked at, and what was taken besides the mission in hand', () => {
    const fence = { ...row('/geoFence/polygons/0', 'taken', null) };
    const corners = [58, 58.1, 58.2].map((lat) => ({ lat, lon: 26 }));
    const [area] = located(
      [fence],
      () => undefined,
      () => corners,
    );
    expect(import_on_map(area ? [area] : [], area ?? null)).toMatchObject([
      { tone: 'taken', places: corners },
      { tone: 'looked', places: corners },
    ]);
  });
});
