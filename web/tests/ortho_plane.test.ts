// Where orthophotos lie by their keys (OGC 19-008r4): units, datums, and what is refused.

import { describe, expect, it } from 'vitest';

import { distance_m } from '../src/model/geo';
import { datum_of, shifts_at } from '../src/ortho/datum';
import { plane_of, type Keys } from '../src/ortho/plane';

const at = (keys: Keys, x: number, y: number): { lat: number; lon: number } => {
  const [lon, lat] = plane_of(keys, [x, y]).inverse(x, y);
  return { lat, lon };
};
const projected = (code: number, more: Keys = {}): Keys => ({
  GTModelTypeGeoKey: 1,
  ProjectedCSTypeGeoKey: code,
  ...more,
});
const why = (keys: Keys, x = 0, y = 0): unknown => {
  try {
    return plane_of(keys, [x, y]).datum;
  } catch (cause) {
    const { why: word, message } = cause as { readonly why: string; readonly message: string };
    return [word, message];
  }
};

const FOOT_US = 9003;
const METRE = 9001;
const USER_DEFINED = 32767;
const TRANSVERSE_MERCATOR = 1;
const MERCATOR = 7;
const TARTU = { lat: 58.378, lon: 26.729 };

describe('a plane in feet', () => {
  // EPSG 2263 by definition: 40°10' N, 74° W is 984,250 US survey feet east, and none north.
  const origin = { lat: 40 + 10 / 60, lon: -74 };

  it('is measured once, whether its unit is said or not', () => {
    for (const keys of [projected(2263), projected(2263, { ProjLinearUnitsGeoKey: FOOT_US })]) {
      expect(distance_m(at(keys, 984_250, 0), origin)).toBeLessThan(0.01);
      const [x, y] = plane_of(keys, [984_250, 0]).forward(origin.lon, origin.lat);
      expect(Math.hypot(x - 984_250, y)).toBeLessThan(0.01);
    }
  });

  it('is measured in metres where the file says so', () => {
    const keys = projected(2263, { ProjLinearUnitsGeoKey: METRE });
    expect(distance_m(at(keys, 300_000, 0), origin)).toBeLessThan(0.01);
  });

  it('is one of a file that defines its own', () => {
    const keys = projected(USER_DEFINED, {
      GeographicTypeGeoKey: 4326,
      ProjectionGeoKey: USER_DEFINED,
      ProjCoordTransGeoKey: TRANSVERSE_MERCATOR,
      ProjLinearUnitsGeoKey: FOOT_US,
      ProjNatOriginLongGeoKey: TARTU.lon,
      ProjNatOriginLatGeoKey: TARTU.lat,
      ProjFalseEastingGeoKey: 1000,
      ProjFalseNorthingGeoKey: 2000,
      ProjScaleAtNatOriginGeoKey: 1,
    });
    expect(distance_m(at(keys, 1000, 2000), TARTU)).toBeLessThan(0.01);
    expect(distance_m(at(keys, 1000, 2100), TARTU)).toBeCloseTo(30.48, 1);
  });
});

describe('a plane on an older datum', () => {
  // As those who keep the grids publish them: of the grid, and of ETRS89.
  it.each([
    ['Amersfoort', 28992, [155_000, 463_000], [52.155172897, 5.387203658], 1],
    ['the old observatory of Bern', 2056, [2_600_000, 1_200_000], [46.951082877, 7.438632495], 1],
    ['Bern, in older numbers', 21781, [600_000, 200_000], [46.951082877, 7.438632495], 2],
    ['Caister water tower', 27700, [651_409.903, 313_177.27], [52.65800783, 1.71607397], 5],
  ] as const)('lies right at %s', (_, code, [x, y], [lat, lon], good_to_m) => {
    expect(distance_m(at(projected(code), x, y), { lat, lon })).toBeLessThan(good_to_m);
  });

  // As PROJ 9.1 lays them, without its grids (gdaltransform, EPSG v10.076): x, y, longitude, latitude.
  it.each([
    [31370, 1, [145153.31, 165506.85, 4.3000001, 50.8]],
    [31467, 3, [3500074.92, 5540407.24, 9, 50]],
    [31287, 2, [449792.43, 455843.78, 14.0000001, 48]],
    [5514, 1, [-745645.2, -1052441.97, 14.4, 50]],
    [23700, 1, [646425.51, 239563.98, 19, 47.5]],
    [2393, 1, [3389254.96, 6678167.77, 25, 60.2]],
    [3300, 1, [657823.89, 6476462.4, 26.7, 58.4]],
    [2100, 1, [473511.08, 4205569.56, 23.7, 38]],
    [3908, 4, [6263884.92, 4988326.27, 15.0000001, 45]],
    [3912, 6, [461643.34, 95211.62, 14.5000001, 45.9999999]],
    [2326, 1, [828346.59, 817897.75, 114.1, 22.3]],
    [29902, 1, [320055.44, 229229.14, -6.2, 53.3]],
    [2039, 1, [200137.81, 656336.67, 35, 32]],
    [3003, 4, [1500026.58, 4760829.68, 9.0000001, 43]],
    [27572, 2, [597316.74, 2422398.9, 2.3, 48.8]],
    [27200, 4, [2594112.58, 6022474.03, 174, -41]],
    [28404, 3, [4564122.46, 6097824.39, 22, 55]],
  ] as const)('lies as PROJ lays it: %i', (code, good_to_m, [x, y, lon, lat]) => {
    expect(distance_m(at(projected(code), x, y), { lat, lon })).toBeLessThan(good_to_m);
  });

  it('says how well that is known, if it is not to a metre', () => {
    expect(plane_of(projected(32635), [500_000, 6_470_000]).datum).toBeNull();
    expect(plane_of(projected(27700), [530_000, 180_000]).datum).toEqual({
      name: 'OSGB36',
      good_to_m: 5,
    });
    expect(plane_of(projected(2263), [984_250, 0]).datum).toEqual({ name: 'NAD83', good_to_m: 4 });
  });

  it('is no better known than the shifts of its areas agree', () => {
    // At Ljubljana a Slovenian shift holds, a Croatian one, and one of all of them.
    const { datum } = plane_of(projected(3912), [461_643, 95_211]);
    expect(datum?.good_to_m).toBeGreaterThan(1);
  });

  it('is refused, by its name, where its shift is not known', () => {
    expect(why(projected(32035), 2e6, 1e5)).toEqual(['no_datum', 'NAD27']);
    // The Dutch grid far from the Netherlands.
    expect(why(projected(28992), 155_000, -2_000_000)).toEqual(['no_datum', 'Amersfoort']);
    const own = { GeogCitationGeoKey: 'Madrid 1870 (Madrid)' };
    expect(why(projected(2062, own), 6e5, 6e5)).toEqual([
      'no_datum',
      'Madrid 1870 (Madrid), EPSG:2062',
    ]);
  });

  it('is refused where its axes point west or south', () => {
    expect(why(projected(22275))).toEqual(['other_axes', '']);
    expect(why(projected(5513))).toEqual(['other_axes', '']);
  });
});

describe('a plane by two systems', () => {
  // The middle of the 35th zone of UTM: 27° E is 500 km east; the equator is 0 m north.
  const MIDDLE = { lat: 0, lon: 27 };

  it('is the projected one', () => {
    const keys = projected(32635, {
      GeographicTypeGeoKey: 4326,
      GeogCitationGeoKey: 'WGS 84|',
      GeogAngularUnitsGeoKey: 9102,
      GeogGeodeticDatumGeoKey: 6326,
      VerticalCSTypeGeoKey: 5773,
    });
    expect(distance_m(at(keys, 500_000, 0), MIDDLE)).toBeLessThan(0.01);
  });

  it('is the geographic one where the model says that', () => {
    const keys = projected(32635, { GTModelTypeGeoKey: 2, GeographicTypeGeoKey: 4326 });
    expect(distance_m(at(keys, 27, 58), { lat: 58, lon: 27 })).toBeLessThan(0.01);
  });

  it('is defined on the geographic one', () => {
    const own = projected(USER_DEFINED, { ProjLinearUnitsGeoKey: METRE });
    const keys = { ...own, GeographicTypeGeoKey: 4326, ProjectionGeoKey: 16035 };
    expect(distance_m(at(keys, 500_000, 0), MIDDLE)).toBeLessThan(0.01);
    // By the number of its datum alone.
    const datum = { ...own, GeogGeodeticDatumGeoKey: 6326, ProjectionGeoKey: 16035 };
    expect(distance_m(at(datum, 500_000, 0), MIDDLE)).toBeLessThan(0.01);
    const old = { ...own, GeographicTypeGeoKey: 4267, ProjectionGeoKey: 16035 };
    expect(why(old, 500_000, 6_000_000)).toEqual(['no_datum', 'NAD27']);
  });

  it('is the web map by its name, which its keys do not say', () => {
    const words = 'ESRI PE String = PROJCS["X",PROJECTION["Mercator_Auxiliary_Sphere"]]';
    const own = { GeographicTypeGeoKey: 4326, ProjCoordTransGeoKey: MERCATOR };
    const keys = projected(USER_DEFINED, { ...own, PCSCitationGeoKey: words });
    // By definition: the sphere's radius times the angle east, and times ln tan(45° + 29.189°) north.
    const radius = 6_378_137;
    const x = (radius * TARTU.lon * Math.PI) / 180;
    const y = radius * Math.log(Math.tan(((45 + TARTU.lat / 2) * Math.PI) / 180));
    expect(distance_m(at(keys, x, y), TARTU)).toBeLessThan(0.01);
  });

  it('is refused where the library would lay it elsewhere', () => {
    const own = { GeographicTypeGeoKey: 4326, ProjNatOriginLatGeoKey: 70 };
    for (const method of [15, 17, 9815]) {
      const keys = projected(USER_DEFINED, { ...own, ProjCoordTransGeoKey: method });
      expect(why(keys)).toEqual(['no_projection', `ProjCoordTransGeoKey ${method}`]);
    }
    const scaled = { ...own, ProjCoordTransGeoKey: MERCATOR, ProjStdParallel1GeoKey: 40 };
    expect(why(projected(USER_DEFINED, scaled))).toEqual([
      'no_projection',
      'ProjCoordTransGeoKey 7',
    ]);
    const numbered = { ...own, ProjectionGeoKey: 10101 };
    expect(why(projected(USER_DEFINED, numbered))).toEqual([
      'no_projection',
      'ProjectionGeoKey 10101',
    ]);
    // Of the systems that the library knows by their codes: a polar one, Maine's in metres.
    expect(why(projected(3031))).toEqual(['no_datum', 'EPSG:3031']);
    expect(why(projected(3073))).toEqual(['no_datum', 'EPSG:3073']);
  });

  it('has its own shift, of whose worth nothing is said, or is not known', () => {
    const own = projected(USER_DEFINED, {
      GeographicTypeGeoKey: USER_DEFINED,
      GeogCitationGeoKey: 'GCS Name = unknown|Datum = Unknown based on Bessel 1841 ellipsoid|',
      GeogSemiMajorAxisGeoKey: 6_377_397.155,
      GeogInvFlatteningGeoKey: 299.1528128,
      ProjectionGeoKey: USER_DEFINED,
      ProjCoordTransGeoKey: 16, // oblique stereographic, as the Dutch grid
      ProjLinearUnitsGeoKey: METRE,
      ProjNatOriginLongGeoKey: 5.38763888888889,
      ProjNatOriginLatGeoKey: 52.1561605555556,
      ProjFalseEastingGeoKey: 155_000,
      ProjFalseNorthingGeoKey: 463_000,
      ProjScaleAtNatOriginGeoKey: 0.9999079,
    });
    const shift = [565.417, 50.3319, 465.552, -0.398957, 0.343988, -1.8774, 4.0725];
    const keys = { ...own, GeogTOWGS84GeoKey: Float64Array.from(shift) };
    const amersfoort = { lat: 52.155172897, lon: 5.387203658 };
    expect(distance_m(at(keys, 155_000, 463_000), amersfoort)).toBeLessThan(1);
    expect(why(keys, 155_000, 463_000)).toEqual({ name: 'TOWGS84', good_to_m: null });
    expect(why(own)).toEqual(['no_datum', 'Unknown based on Bessel 1841 ellipsoid']);
  });
});

describe('the table of datums', () => {
  it('knows codes by their ranges', () => {
    expect(datum_of(28992)?.name).toBe('Amersfoort');
    expect(datum_of(32635)).toBe(datum_of(4326));
    expect(datum_of(30001)).toBeNull();
  });

  it('knows areas across 180°', () => {
    const pulkovo = datum_of(4284);
    if (!pulkovo) throw new Error('not listed');
    expect(shifts_at(pulkovo, -170, 66).length).toBeGreaterThan(0);
    expect(shifts_at(pulkovo, 37, 56).length).toBeGreaterThan(0);
    expect(shifts_at(pulkovo, -100, 40)).toEqual([]);
  });
});
